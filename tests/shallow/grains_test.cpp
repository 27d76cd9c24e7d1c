// The steady uniform state of the solver against particle flows at the same angle and thickness:
// validation/weinhart2012/steady-points/results.csv.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "shallow/support.hpp"

using namespace shallow_test;

namespace {

std::vector<std::map<std::string, std::string>> particle_flows() {
  std::ifstream file(BAGNOLD_SOURCE_DIR "/validation/weinhart2012/steady-points/results.csv");
  const auto cells = [](const std::string& line) {
    std::vector<std::string> out;
    std::istringstream words(line);
    for (std::string cell; std::getline(words, cell, ',');) out.push_back(cell);
    return out;
  };
  std::string line;
  std::getline(file, line);
  const auto names = cells(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(file, line)) {
    const auto values = cells(line);
    std::map<std::string, std::string> row;
    for (std::size_t k = 0; k < names.size(); ++k) row[names[k]] = values.at(k);
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

TEST(Grains, SteadyFlowsHaveTheVelocityOfTheSolver) {
  const auto set = *closure::builtin("weinhart2012/1", 1, 6 / std::numbers::pi);
  int within = 0;
  for (const auto& row : particle_flows()) {
    const auto number = [&](const char* name) { return std::stod(row.at(name)); };
    const double theta = number("theta_deg"), h = number("h");
    Definition s = line(4, 0, 8, theta, set);
    s.boundary[0].kind = s.boundary[1].kind = BoundaryKind::periodic;
    Flow run(s);
    run.fill([&](double, double) { return h; }, [&](double, double) { return number("u_solver"); });
    run.to(500);
    const Profile p = run.profile();
    const double F = p.u[1] / std::sqrt(p.h[1] * std::cos(rad(theta)));
    EXPECT_NEAR(F / number("F_solver"), 1, 0.01) << theta << ' ' << h;  // the table is that of this solver
    within += std::abs(F - number("F")) < *set.flow_rule_error ? 1 : 0;
  }
  EXPECT_GE(within, 3);
}

// From rest as well: the friction law starts the layer and stops its acceleration.
TEST(Grains, ALayerAtRestReachesTheSteadyState) {
  const auto set = *closure::builtin("weinhart2012/1", 1, 6 / std::numbers::pi);
  Definition s = line(4, 0, 8, 26, set);
  s.boundary[0].kind = s.boundary[1].kind = BoundaryKind::periodic;
  Flow run(s);
  run.fill([](double, double) { return 10; });
  run.to(500);
  const Profile p = run.profile();
  const laws::PouliquenForterre law;
  EXPECT_NEAR(p.u[1] / std::sqrt(p.h[1] * std::cos(rad(26))),
              law.beta * p.h[1] / laws::stopping_height(law, 26) - law.gamma, 1e-3);
}

// Every case of the shallow-layer model, shortened where it is long, asserting a number.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "io/csv.hpp"
#include "io/json.hpp"
#include "support/program.hpp"

namespace bagnold::test {
namespace {

struct Layer {
  nlohmann::json summary;
  io::CsvTable series;
  std::optional<io::CsvTable> end;  // final.csv of a one-dimensional case
};

Layer run_layer(const std::string& name, const std::string& set = "") {
  const Scratch scratch;
  const Outcome outcome = bagnold(scratch, "run '" + case_file(name) + "' -o out --quiet " + set);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  Layer layer{io::read_json(scratch / "out" / "summary.json"), io::read_csv(scratch / "out" / "series.csv"), {}};
  if (fs::exists(scratch / "out" / "final.csv"))
    layer.end = io::read_csv(scratch / "out" / "final.csv", io::CsvHeader::names_and_units);
  EXPECT_LT(std::abs(layer.summary["mass_error_rel"].get<double>()), 1e-11);
  EXPECT_GE(layer.summary["min_h"].get<double>(), 0);
  return layer;
}

// The value of `column` where x is nearest to `x`.
double at(const Layer& layer, const std::string& column, double x) {
  const auto& xs = (*layer.end)["x"];
  std::size_t best = 0;
  for (std::size_t i = 1; i < xs.size(); ++i)
    if (std::abs(xs[i] - x) < std::abs(xs[best] - x)) best = i;
  return (*layer.end)[column][best];
}

TEST(Cases, DamBreakInclineTomlMatchesTheExactSolution) {
  const Layer r = run_layer("dam-break-incline.toml");
  // h = (2 c0 - x/t + m t/2)^2 / (9 G), u = 2/3 (x/t + c0 + m t); Mangeney et al. 2000.
  const double degree = std::numbers::pi / 180, G = std::cos(30 * degree),
               m = G * (std::tan(30 * degree) - std::tan(20 * degree));
  const double t = r.summary["time"], c0 = std::sqrt(10 * G);
  for (const double x : {-10.1, 0.1, 10.1, 20.1}) {
    const double root = 2 * c0 - x / t + 0.5 * m * t;
    EXPECT_NEAR(at(r, "h", x), root * root / (9 * G), 0.03) << x;
    EXPECT_NEAR(at(r, "u", x), 2.0 / 3 * (x / t + c0 + m * t), 0.03) << x;
  }
}

TEST(Cases, RollWavesTomlGrowsFromASmallPerturbation) {
  const Layer r = run_layer("roll-waves.toml");
  const double lowest = r.summary["min_h"], highest = r.summary["max_h"];
  EXPECT_GT(highest - lowest, 2.0);  // from 10 -+ 0.2: F is above the threshold of the linear theory
  EXPECT_GT(lowest, 0);
}

TEST(Cases, FrontTomlAdvancesWithTheFlowBehindIt) {
  const Layer r = run_layer("front.toml");
  // Behind the front the layer is uniform: F = beta h/h_stop - gamma, and so is the speed of the front.
  EXPECT_NEAR(at(r, "h", 300.5), 10.0, 0.05);
  const double u = at(r, "u", 300.5);
  const auto &t = r.series["t"], &front = r.series["front"];
  std::size_t late = 0;
  while (t[late] < 500) ++late;
  // one cell in 267 is 0.4 %
  EXPECT_NEAR((front.back() - front[late]) / (t.back() - t[late]), u, 0.015 * u);
}

TEST(Cases, ContractionTomlSendsAJumpUpstream) {
  const Layer r = run_layer("contraction.toml");
  // Too narrow for a stream of F = 2.5: a jump runs upstream from it, slow behind, fast in the narrows.
  const double gc = std::cos(25 * std::numbers::pi / 180);
  const auto froude = [&](double x) { return at(r, "u", x) / std::sqrt(gc * at(r, "h", x)); };
  EXPECT_GT(froude(-30), 2);
  EXPECT_LT(froude(-10), 0.5);
  EXPECT_GT(froude(19), 1);
  EXPECT_GT(at(r, "h", -10), 3.5 * at(r, "h", -30));
}

TEST(Cases, PileReleaseTomlStopsOnTheRunOut) {
  const Layer r = run_layer("pile-release.toml",
                            "--set scenario.cells=100 --set scenario.cells_across=40 --set output.vtk_every=100");
  EXPECT_EQ(r.summary["status"], "arrested");
  EXPECT_GT(r.summary["front"], 330);          // beyond the bend at 250 ... 330
  EXPECT_EQ(r.series["speed_max"].back(), 0);  // and stays
}

TEST(Cases, ValleyTomlRunsDownTheValley) {
  const Layer r = run_layer("valley.toml", "--set time.end=60");
  EXPECT_GT(r.summary["front"], 501000.0);
  EXPECT_LT(r.summary["max_speed"], 60.0);
  EXPECT_GT(r.summary["max_speed"], 20.0);
}

}  // namespace
}  // namespace bagnold::test

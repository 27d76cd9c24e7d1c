// Every case of the particle model, made smaller and shorter, asserting a number.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "io/csv.hpp"
#include "io/json.hpp"
#include "support/program.hpp"

namespace bagnold::test {
namespace {

struct Result {
  nlohmann::json summary;
  io::CsvTable series;
};

Result run_case(const std::string& name, const std::string& set) {
  const Scratch scratch;
  const Outcome outcome = bagnold(scratch, "run '" + case_file(name) + "' -o out --quiet " + set);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return {io::read_json(scratch / "out" / "summary.json"), io::read_csv(scratch / "out" / "series.csv")};
}

const std::string small_chute = " --set scenario.length=8 --set scenario.width=6 --set scenario.fill_height=6";

TEST(Cases, ChuteTomlFlowsWithoutLargeOverlaps) {
  const Result r = run_case(
      "chute.toml",
      small_chute + " --set scenario.angle_deg=27 --set cg.from=30 --set time.end=40 --set output.series_every=0.5");
  EXPECT_EQ(r.summary["status"], "completed");
  EXPECT_EQ(r.summary["grains"], 288);
  const auto &t = r.series["t"], &u = r.series["u_x"], &overlap = r.series["max_overlap_over_radius"];
  EXPECT_GT(u.back(), 0.15);  // flows well above h_stop(27 deg) = 2.8
  for (std::size_t k = 0; k < t.size(); ++k)
    if (t[k] > 25) {
      EXPECT_LT(overlap[k], 0.01) << t[k];
    }
}

TEST(Cases, ChuteTomlArrestsBelowItsStoppingAngle) {
  const Result r =
      run_case("chute.toml", small_chute + " --set scenario.angle_deg=12 --set time.end=200 --set cg.from=100");
  EXPECT_EQ(r.summary["status"], "arrested");
  EXPECT_LT(r.summary["energy"]["ratio"], 1e-5);
}

TEST(Cases, DemoTomlFlows) {
  const Result r = run_case("demo.toml", small_chute + " --set time.end=15 --set cg.from=10");
  EXPECT_EQ(r.summary["status"], "completed");
  EXPECT_GT(r.series["u_x"].back(), 0.3);
}

// The balances of a steady flow, made quick by soft grains: softness changes neither.
TEST(Cases, DemoTomlBalancesItsWeight) {
  const Result r = run_case("demo.toml",
                            "--set contact.collision_time=0.02 --set scenario.length=7 --set scenario.width=7 --set "
                            "scenario.fill_height=9 --set time.end=130 --set cg.from=70");
  const auto& flow = r.summary["flow"];
  EXPECT_EQ(flow["regime"], "steady");
  EXPECT_LT(flow["lithostatic_error"], 0.005);
  EXPECT_LT(flow["friction_angle_error_deg"], 0.4);
  EXPECT_NEAR(flow["mu_base"], std::tan(26 * std::numbers::pi / 180), 0.01);
  EXPECT_LT(flow["layering"], 0.3);
}

TEST(Cases, FlatBaseTomlSlipsAlongThePlane) {
  const Result r = run_case("flat-base.toml", small_chute + " --set time.end=30");
  EXPECT_EQ(r.summary["base_grains"], 0);
  // Without a base to hold it, at 20 degrees and mu = 1/2 the layer runs faster than over grains.
  EXPECT_GT(r.series["u_x"].back(), 0.5);
  EXPECT_GT(r.series["z_mean"].back(), 2.0);  // nothing fell through
}

TEST(Cases, SmoothBaseTomlRunsOverSmallGrains) {
  const Result r =
      run_case("smooth-base.toml",
               " --set scenario.length=4 --set scenario.width=3 --set scenario.fill_height=6 --set time.end=20");
  EXPECT_GT(r.summary["base_grains"], 60);
  EXPECT_GT(r.series["z_mean"].back(), 2.0);
  EXPECT_GT(r.series["u_x"].back(), 0.05);
}

TEST(Cases, TwoGrainsTomlKeepsItsEnergy) {
  const Result r = run_case("two-grains.toml", "");
  const auto &residual = r.series["ledger_residual"], &normal = r.series["e_normal_spring"];
  double worst = 0, peak = 0;
  for (std::size_t k = 0; k < residual.size(); ++k) {
    worst = std::max(worst, std::abs(residual[k]));
    peak = std::max(peak, normal[k]);
  }
  EXPECT_NEAR(peak, 0.25, 1e-3);  // the normal part of the kinetic energy 1/2 goes through the spring
  EXPECT_LT(worst, 5e-4);         // of an energy of 1/2
  EXPECT_LT(std::abs(residual.back()), 1e-4);
}

TEST(Cases, AvalancheTomlRunsOutDownTheSlope) {
  const Result r =
      run_case("avalanche.toml",
               "--set seed=3 --set scenario.base_size_ratio=2 --set scenario.width=4 --set scenario.length=40 --set "
               "scenario.height=4 --set scenario.extent=16 --set scenario.centre=9 --set scenario.angle_deg=28 --set "
               "time.end=5");
  const auto& avalanche = r.summary["avalanche"];
  const double cap = 2.0 / 3 * 4 * 16 * 4 * 0.58 * 6 / std::numbers::pi;  // grains under the parabola
  EXPECT_NEAR(r.summary["grains"].get<double>(), cap, 0.1 * cap);
  EXPECT_GT(avalanche["front"], 18.5);  // from below 17
  EXPECT_LT(avalanche["front"], 30);
  EXPECT_GT(avalanche["middle"], 10);  // from 9
  EXPECT_GT(avalanche["tail"], 1);
}

TEST(Cases, ColumnTomlSpreadsAndKeepsItsMass) {
  const Result r =
      run_case("column.toml",
               "--set scenario.radius=0.016 --set scenario.height=0.016 --set scenario.length=0.08 --set time.end=0.2");
  const auto& column = r.summary["column"];
  EXPECT_NEAR(column["aspect_ratio"], 1.0, 1e-12);
  EXPECT_GT(column["runout"], 0.2);
  EXPECT_LT(column["runout_90"], column["runout"]);
  EXPECT_LT(column["runout_50"], column["runout_90"]);
  EXPECT_GT(column["runout_50"], std::sqrt(0.5) * 0.7 - 1);  // half of the mass of a cylinder is within 0.71 r0
  EXPECT_LT(column["height_final"], 0.018);
}

TEST(Cases, HeapTomlStandsAtAnAngle) {
  const Result r =
      run_case("heap.toml",
               "--set scenario.grains=150 --set scenario.radius=0.014 --set scenario.length=0.08 --set time.end=0.4");
  const double slope = r.summary["heap"]["slope_deg"];
  EXPECT_GT(slope, 5);
  EXPECT_LT(slope, 45);
}

}  // namespace
}  // namespace bagnold::test

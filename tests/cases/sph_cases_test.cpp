// Every case of the continuum model, coarser and shorter, asserting a number.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/json.hpp"
#include "support/program.hpp"

namespace bagnold::test {
namespace {

nlohmann::json run_continuum(const std::string& name, const std::string& set) {
  const Scratch scratch;
  const Outcome outcome = bagnold(scratch, "run '" + case_file(name) + "' -o out --quiet " + set);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return io::read_json(scratch / "out" / "summary.json");
}

TEST(Cases, InclineTomlApproachesItsSteadyProfile) {
  const auto summary = run_continuum("incline.toml", "--set scenario.spacing=0.01 --set time.end=3");
  // At 3 s the surface has reached 0.88 of its final speed (transient of the one-dimensional momentum equation).
  const double u = summary["u_surface"], exact = summary["u_surface_exact"];
  EXPECT_GT(u / exact, 0.75);
  EXPECT_LT(u / exact, 1.05);
}

// The one-dimensional momentum equation for 0.03 m changes by less than 1e-3 a second after 2.6 s. (With fewer rows than 12
// the mean velocity itself wavers by as much.)
TEST(Cases, SteadyTimeIsWhenTheMeanVelocityStopsChanging) {
  const std::string thin = "--set scenario.height=0.03 --set scenario.length=0.03 --set scenario.spacing=0.0025 ";
  EXPECT_NEAR(run_continuum("incline.toml", thin + "--set time.end=3.5")["steady_time"], 2.75, 0.5);
  EXPECT_TRUE(run_continuum("incline.toml", thin + "--set time.end=1")["steady_time"].is_null());
}

TEST(Cases, HeapAtRestTomlHolds) {
  const auto summary = run_continuum("heap-at-rest.toml", "--set scenario.spacing=0.004 --set time.end=0.2");
  const double speed = summary["speed_rms"];
  EXPECT_LT(speed, 1e-3 * 0.32e-3 / std::sqrt(0.04 / 9.81));
  EXPECT_GT(speed, 0);
}

TEST(Cases, ContinuumFieldsOnAGridLieBesideTheParticles) {
  const Scratch scratch;
  const Outcome outcome = bagnold(scratch, "run '" + case_file("column-3.toml") +
                                               "' -o out --quiet --set scenario.spacing=0.0081 --set time.end=0.02");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(read_text(scratch / "out" / "vtk" / "fields.pvd").find("fields_00000.vti"), std::string::npos);
  const std::string fields = read_text(scratch / "out" / "vtk" / "fields_00000.vti");
  for (const char* name : {"p", "rho", "i", "eta", "speed"})
    EXPECT_NE(fields.find("Name=\"" + std::string(name) + "\""), std::string::npos) << name;
}

TEST(Cases, ColumnsStopWhenTheyHaveArrested) {
  const std::string coarse = "--set scenario.spacing=0.0081 --set time.end=1 ";
  const auto stopped = run_continuum("column-3.toml", coarse),
             whole = run_continuum("column-3.toml", coarse + "--set time.stop_when_arrested=false");
  EXPECT_EQ(stopped["status"], "arrested");
  EXPECT_EQ(whole["status"], "arrested");
  EXPECT_LT(stopped["time"], 0.8);
  EXPECT_GE(whole["time"], 1.0);
  const double there = stopped["runout"], later = whole["runout"];
  EXPECT_NEAR(there, later, 0.02);
  const auto moving = run_continuum("column-3.toml", "--set scenario.spacing=0.0081 --set time.end=0.2");
  EXPECT_EQ(moving["status"], "completed");
}

class ColumnToml : public testing::TestWithParam<int> {};

TEST_P(ColumnToml, CollapsesOutwards) {
  // Rows of table 3 of Minatti & Paris: column-1.toml, column-2.toml, column-3.toml, column-4.toml, column-5.toml, column-6.toml.
  const double aspect[] = {0.19, 0.55, 0.90, 1.60, 2.75, 3.00},
               height[] = {0.0185, 0.0535, 0.0875, 0.1555, 0.2673, 0.2916};
  const auto k = static_cast<std::size_t>(GetParam() - 1);
  const double dp = k == 0 ? 0.0030 : 0.0081;
  const std::string spacing = " --set scenario.spacing=" + std::to_string(dp);
  const auto summary = run_continuum("column-" + std::to_string(GetParam()) + ".toml", "--set time.end=0.15" + spacing);
  EXPECT_NEAR(summary["aspect_ratio"], aspect[k], 0.01);
  EXPECT_GT(summary["r_final"], 1.02 * 0.0972);
  EXPECT_GT(summary["runout"], 0.02);
  EXPECT_LT(summary["runout_90"], summary["runout"]);
  EXPECT_GT(summary["runout_50"], std::sqrt(0.5) - 1.05);  // half of the mass begins within 0.71 r0
  EXPECT_LT(summary["runout_50"], summary["runout_90"]);
  EXPECT_LT(summary["height_final"], height[k] + 0.55 * dp);  // whole rows; low columns keep their middle
}

INSTANTIATE_TEST_SUITE_P(Rows, ColumnToml, testing::Range(1, 7));

}  // namespace
}  // namespace bagnold::test

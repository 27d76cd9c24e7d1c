// Continuum runs as users meet them: cut and resumed with the same bits, energies on demand.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/csv.hpp"
#include "io/json.hpp"
#include "support/program.hpp"
#include "support/same_state.hpp"

namespace bagnold::test {
namespace {

// Improved: implicit, shifting and all; printed: explicit, artificial viscosity, ghosts, periodic.
const std::string improved =
    "run '" + case_file("column-3.toml") + "' --quiet --set scenario.spacing=0.0054 --set time.end=0.2 ";
const std::string printed =
    "run '" + case_file("incline.toml") +
    "' --quiet --set numerics.operator=minatti2015 --set numerics.stepping=minatti2015 --set numerics.shifting=0 "
    "--set numerics.volume_correction=0 --set numerics.density_diffusion=0 --set numerics.cfl=0.5 "
    "--set numerics.artificial_viscosity=0.05 --set scenario.height=0.03 --set scenario.length=0.03 --set "
    "time.end=2 ";
const std::string often =
    "--set output.series_every=0.002 --set output.snapshot_every=0.05 --set output.vtk_every=0.1 ";

class Continuum : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Runs, Continuum, testing::Values(improved, printed),
                         [](const auto& p) { return std::string(p.index == 0 ? "Improved" : "Printed"); });

TEST_P(Continuum, InterruptedAndResumedGivesTheSameBits) {
  const Scratch scratch;
  const std::string run = GetParam() + often + "--set output.energy_ledger=true ";
  ASSERT_EQ(bagnold(scratch, run + "-o whole").exit_code, 0);
  const Outcome cut = bagnold_cut(scratch, run + "-o cut", "cut", 30);
  ASSERT_EQ(cut.exit_code, 75) << cut.err;
  const auto stopped = io::read_json(scratch / "cut" / "summary.json");
  EXPECT_EQ(stopped["status"], "interrupted");
  EXPECT_LT(stopped["time"], io::read_json(scratch / "whole" / "summary.json")["time"]);
  const Outcome rest = bagnold(scratch, "resume cut --quiet");
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  expect_same_state(scratch / "whole", scratch / "cut");
  EXPECT_TRUE(read_text(scratch / "whole" / "series.csv") == read_text(scratch / "cut" / "series.csv"));
  for (const char* name : {"vtk/particles.pvd", "vtk/particles_00002.vtp", "vtk/fields_00002.vti"}) {
    ASSERT_TRUE(fs::exists(scratch / "whole" / name)) << name;
    EXPECT_TRUE(read_text(scratch / "whole" / name) == read_text(scratch / "cut" / name)) << name;
  }
  auto whole = io::read_json(scratch / "whole" / "summary.json"),
       resumed = io::read_json(scratch / "cut" / "summary.json");
  for (const char* clock : {"wall_s", "cpu_s", "particle_steps_per_s", "threads"}) whole.erase(clock), resumed.erase(clock);
  EXPECT_EQ(whole, resumed);
}

// Output and the ledger change no bit of the flow, and the ledger closes.
TEST_P(Continuum, EnergiesCloseAndChangeNothing) {
  const Scratch scratch;
  const std::string run = GetParam() + "--set time.end=0.05 ";
  ASSERT_EQ(bagnold(scratch, run + "-o plain").exit_code, 0);
  ASSERT_EQ(bagnold(scratch, run + often + "--set output.energy_ledger=true -o kept").exit_code, 0);
  const auto a = io::H5File::read_only(scratch / "plain" / "checkpoint.h5"),
             b = io::H5File::read_only(scratch / "kept" / "checkpoint.h5");
  for (const char* name : {"x_0", "x_1", "v_0", "v_1", "rho", "root"})
    EXPECT_EQ(a.read<double>(std::string("state/sph/") + name), b.read<double>(std::string("state/sph/") + name))
        << name;
  EXPECT_FALSE(io::read_json(scratch / "plain" / "summary.json").contains("energy"));
  const auto energy = io::read_json(scratch / "kept" / "summary.json")["energy"];
  const double gravity = energy["gravity_work"];
  EXPECT_GT(gravity, 0);
  double rest = gravity - energy["pressure_work"].get<double>() - energy["kinetic_energy"].get<double>();
  for (const char* lost : {"friction", "bulk", "residual", "artificial", "stepping", "walls"})
    rest -= energy[std::string("lost_") + lost].get<double>();
  EXPECT_NEAR(rest, 0, 1e-11 * gravity);
  EXPECT_GT(energy["lost_friction"], 0.5 * (gravity - energy["kinetic_energy"].get<double>()));
}

}  // namespace
}  // namespace bagnold::test

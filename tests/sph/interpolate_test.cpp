// Fields on a grid.
#include "sph/interpolate.hpp"

#include "core/error.hpp"
#include "helpers.hpp"

namespace bagnold::sph::test {
namespace {

// A tank 0.1 m x 0.06 m, periodic, over the floor, sheared so slowly (1e-3/s) that it does not dilate.
struct Tank {
  Model model = incline_model();
  State state;
  Work work;
  explicit Tank(bool better) {
    if (better) improve(model);
    const scenario::InclinedPlane plane{.angle_deg = 0, .height = 0.06, .length = 0.1, .spacing = 5e-3};
    set_geometry(plane, model);
    state.particles = make_particles(plane, model);
    initialise(state, work, model);
    for (std::size_t i = 0; i < state.particles.mass.size(); ++i)
      state.particles.v[0][i] = 1e-3 * state.particles.x[1][i];
    refresh(state, work, model);
  }
};

TEST(Interpolation, ReturnsWhatTheParticlesCarry) {
  for (const bool better : {false, true}) {
    const Tank tank(better);
    const GridFields g = interpolate(tank.state, tank.work, tank.model);
    EXPECT_EQ(g.cells[0], 20);
    EXPECT_EQ(g.cells[1], 1);
    EXPECT_EQ(g.origin[2], 0);
    for (std::int64_t c = 0; c < g.cells[2]; ++c)
      for (std::int64_t a = 0; a < g.cells[0]; ++a) {
        const auto k = static_cast<std::size_t>(c * g.cells[0] + a);
        const double z = (static_cast<double>(c) + 0.5) * g.spacing;
        if (z > 0.06) {
          EXPECT_LT(g.filled[k], 0.5);
          EXPECT_TRUE(std::isnan(g.pressure[k]) && std::isnan(g.speed[k]) && std::isnan(g.inertial_number[k]));
          continue;
        }
        if (z > 0.045) continue;            // the surface: a kernel sees one side only
        EXPECT_NEAR(g.filled[k], 1, 0.02);  // 1.01 on the lattice
        EXPECT_NEAR(g.density[k], 480, 5);
        EXPECT_NEAR(g.velocity[0][k], 1e-3 * z, 1e-5 * 0.06);  // mirrored under the floor: linear down to it
        EXPECT_NEAR(g.speed[k], std::abs(g.velocity[0][k]), 1e-12);
        if (z > 0.015) EXPECT_NEAR(g.pressure[k], 480 * 9.81 * (0.06 - z), 0.02 * 480 * 9.81 * 0.06);
      }
  }
}

TEST(Interpolation, ParticlesFlownApartAreAnErrorNotAHugeFile) {
  Tank tank(true);
  tank.model.period = {0, 0, 0};
  tank.state.particles.x[0][0] = 1e6;
  EXPECT_THROW(interpolate(tank.state, tank.work, tank.model, 1'000'000), NumericalError);
}

}  // namespace
}  // namespace bagnold::sph::test

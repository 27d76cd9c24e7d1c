// Grains on a frictional plane that do not meet: analytic accelerations, as a tilted plane and as tilted gravity. One is a
// matter for the plain engine, many for the fast one.
#include <gtest/gtest.h>

#include "dem/fast/engine.hpp"
#include "helpers.hpp"

namespace bagnold::dem {
namespace {
using testing::add_grain;

// Acceleration along the plane once the grain has found its speed.
double acceleration(double angle, double mu, bool tilt_the_plane, Vec3& spin, int grains) {
  DemState s;
  s.dt = 1e-4;
  const double sn = std::sin(angle), cs = std::cos(angle);
  const Vec3 normal = tilt_the_plane ? Vec3{sn, 0, cs} : Vec3{0, 0, 1},
             along = tilt_the_plane ? Vec3{cs, 0, -sn} : Vec3{1, 0, 0};
  s.gravity = tilt_the_plane ? Vec3{0, 0, -1} : Vec3{sn, 0, -cs};
  s.walls = {{{0.3, 0, 0.2}, normal, 0}};
  const Vec3 across = cross(normal, along);
  for (int k = 0; k < grains; ++k)
    add_grain(s, s.walls[0].point + (0.5 - cs / 2e5) * normal + k / 10 * 1.2 * along + k % 10 * 1.2 * across);
  const auto laws = testing::paper_laws(25, mu);
  prepare(s, laws);
  EXPECT_EQ(fast::supports(s), grains > 1);
  advance(s, laws, 10000);
  const double v1 = dot(full_step_velocity(s, 0), along);
  advance(s, laws, 20000);
  spin = full_step_omega(s, 0);
  for (int k = 1; k < grains; ++k) EXPECT_LT(norm(full_step_velocity(s, k) - full_step_velocity(s, 0)), 1e-9);
  EXPECT_NEAR(dot(s.grains.x[0] - s.walls[0].point, normal), 0.5 - cs / 2e5, 1e-7);
  return (dot(full_step_velocity(s, 0), along) - v1) / (20000 * s.dt);
}

constexpr std::pair<bool, int> cases[]{{false, 1}, {true, 1}, {false, 80}, {true, 80}};

TEST(Incline, SlidingGrain) {
  const double angle = 50 * std::numbers::pi / 180, mu = 0.2;  // tan(angle) > 7/2 mu: slides
  const double exact = std::sin(angle) - mu * std::cos(angle);
  for (const auto& [tilted, grains] : cases) {
    Vec3 spin;
    EXPECT_NEAR(acceleration(angle, mu, tilted, spin, grains), exact, 1e-3 * exact);
    EXPECT_NEAR(spin.y, 2.5 * mu * std::cos(angle) / 0.5 * 3, 0.02);  // torque mu N r over 2/5 m r^2, for t = 3
  }
}

TEST(Incline, RollingGrain) {
  const double angle = 20 * std::numbers::pi / 180;
  const double exact = 5.0 / 7 * std::sin(angle);
  for (const auto& [tilted, grains] : cases) {
    Vec3 spin;
    EXPECT_NEAR(acceleration(angle, 0.5, tilted, spin, grains), exact, 1e-3 * exact);
    EXPECT_NEAR(spin.y, exact / 0.5 * 3, 1e-3 * spin.y);
  }
}

}  // namespace
}  // namespace bagnold::dem

// Problem 6: rest is exact. Deposits below the static limit do not move by one bit, whichever way the plane lies in the grid.
#include <gtest/gtest.h>

#include "shallow/support.hpp"

using namespace shallow_test;

namespace {

closure::ClosureSet with_starting_angle(double delta, double start) {
  closure::ClosureSet set = coulomb(delta);
  set.static_branch = {.froude_star = 0.1, .delta1_deg = delta, .delta2_deg = delta, .delta3_deg = start, .length = 1};
  return set;
}

void expect_frozen(Flow& run, double t) {
  const std::vector<double> D = run.state.now.D;
  const Grid& g = run.solver.setup.grid;
  run.to(t);
  ASSERT_GT(run.state.step, 10);
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) ASSERT_EQ(run.state.now.D[g.at(i, j)], D[g.at(i, j)]) << i << ' ' << j;
  EXPECT_TRUE(at_rest(run.solver, run.state));
}

}  // namespace

TEST(Problem06, LakeAtRestWithDryIslands) {
  for (double K : {1.0, 0.95}) {
    Definition s = line(200, 0, 10, 0, coulomb(0, 1, K));
    s.bed = padded_bed(s.grid,
                       [](double x, double) { return 0.8 * std::exp(-4 * (x - 3) * (x - 3)) + 0.3 * std::sin(2 * x); });
    s.boundary[0].kind = s.boundary[1].kind = BoundaryKind::wall;
    Flow run(s);
    const Grid& g = run.solver.setup.grid;
    for (int i = 0; i < g.nx; ++i)
      set_cell(run.solver, run.state, i, 0, std::max(0.0, (0.4 - run.solver.bed[g.at(i, 0)]) / K));
    refresh(run.solver, run.state);
    expect_frozen(run, 20);
  }
}

TEST(Problem06, PilesOnInclinedPlanesTurnedInTheGrid) {
  // slope of the surface: at most tan(theta) + 2 H/L < tan(25 deg)
  for (double direction : {0.0, 30.0, 45.0, 90.0, 200.0}) {
    Flow run(square(60, 3, 15, with_starting_angle(24, 25), direction));
    run.fill([](double x, double y) { return std::max(0.0, 0.35 * (1 - std::hypot(x, y) / 2)); });
    expect_frozen(run, 5);
  }
}

TEST(Problem06, PileOnABumpySlope) {
  Definition s = square(60, 3, 15, coulomb(28), 30);
  s.bed = padded_bed(s.grid, [](double x, double y) { return 0.02 * std::sin(3 * x) * std::cos(2 * y); });
  Flow run(s);
  run.fill([](double x, double y) { return std::max(0.0, 0.18 * (1 - (x * x + y * y) / 4)); });
  expect_frozen(run, 5);
}

TEST(Problem06, PileOnRealTerrain) {
  Definition s = square(60, 3, 0, coulomb(30));
  s.gravity = {.normal = 1, .g = 1};
  s.terrain = true;
  s.bed = padded_bed(s.grid, [](double x, double y) { return 0.05 * x * x - 0.3 * y + 0.02 * std::sin(3 * x); });
  Flow run(s);
  run.fill([](double x, double y) { return std::max(0.0, 0.2 * (1 - (x * x + y * y) / 2)); });
  expect_frozen(run, 5);
}

TEST(Problem06, MeasuredFrictionHoldsALayerUpToItsStartingAngle) {
  const auto set = *closure::builtin("weinhart2012/1", 1, 6 / std::numbers::pi);
  const double h = 5, start = std::atan(starting_friction(set, 1, h)) * 180 / std::numbers::pi;
  for (double offset : {-0.05, 0.05}) {
    Definition s = line(20, 0, 100, start + offset, set);
    s.boundary[0].kind = s.boundary[1].kind = BoundaryKind::periodic;
    s.scheme.tip_depth = 3;
    Flow run(s);
    run.fill([&](double, double) { return h; });
    run.to(100);
    EXPECT_EQ(at_rest(run.solver, run.state), offset < 0);
  }
}

// A heap that is too steep slides, comes to rest in finite time, and then stays for good.
TEST(Problem06, ACollapsedHeapStopsAndStays) {
  Flow run(square(64, 5, 10, coulomb(22), 30));
  run.fill([](double x, double y) { return std::hypot(x, y) < 0.8 ? 0.8 : 0; });
  const double mass = total_mass(run.solver, run.state);
  double t = 0;
  while (!at_rest(run.solver, run.state) || run.state.step < 5) {
    ASSERT_LT(t += 0.5, 60) << "still creeping";
    run.to(t);
  }
  EXPECT_EQ(mass_crossed(run.solver, run.state), 0);
  expect_frozen(run, t + 20);
  EXPECT_NEAR(total_mass(run.solver, run.state) / mass, 1, 1e-13);
}

// What must not change the result: mirrors, quarter turns, threads, tiles, cuts; and what must be conserved.
#include <gtest/gtest.h>

#include "core/parallel.hpp"
#include "shallow/support.hpp"

using namespace shallow_test;

namespace {

closure::ClosureSet all_closures() {
  auto set = *closure::builtin("weinhart2012/1", 1, 6 / std::numbers::pi);
  return set;
}

double lump(double x, double y) { return std::max(0.0, 14 * (1 - ((x - 8) * (x - 8) + 2 * (y + 5) * (y + 5)) / 300)); }

Definition release(int n, double direction, bool measured) {
  Definition s = square(n, 40, 26, measured ? all_closures() : coulomb(20, 1.2), direction);
  s.scheme.tip_depth = 3;
  s.scheme.dry_depth = 1e-4;
  return s;
}

}  // namespace

TEST(Invariance, MirrorAndQuarterTurnsBitForBit) {
  for (bool measured : {false, true}) {
    const int n = 50;
    const auto exact_direction = [](Definition s, double cx, double cy) {
      s.gravity.slope_x = cx * tan_d(26);
      s.gravity.slope_y = cy * tan_d(26);
      return s;
    };
    Flow plain(exact_direction(release(n, 0, measured), 0.8, 0.6)),
        mirrored(exact_direction(release(n, 0, measured), 0.8, -0.6)),
        turned(exact_direction(release(n, 0, measured), -0.6, 0.8));
    plain.fill(lump);
    const Grid& g = plain.solver.setup.grid;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const double D = plain.state.now.D[g.at(i, j)];
        mirrored.state.now.D[g.at(i, n - 1 - j)] = D;
        turned.state.now.D[g.at(n - 1 - j, i)] = D;  // (x, y) -> (-y, x)
      }
    refresh(mirrored.solver, mirrored.state);
    refresh(turned.solver, turned.state);
    for (auto* run : {&plain, &mirrored, &turned}) run->to(10);
    ASSERT_GT(plain.state.step, 10);
    ASSERT_EQ(plain.state.time, turned.state.time);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const std::size_t c = g.at(i, j), m = g.at(i, n - 1 - j), q = g.at(n - 1 - j, i);
        ASSERT_EQ(plain.state.now.D[c], mirrored.state.now.D[m]) << measured << ' ' << i << ' ' << j;
        ASSERT_EQ(plain.state.now.My[c], -mirrored.state.now.My[m]);
        ASSERT_EQ(plain.state.now.D[c], turned.state.now.D[q]) << measured << ' ' << i << ' ' << j;
        ASSERT_EQ(plain.state.now.Mx[c], turned.state.now.My[q]);
        ASSERT_EQ(plain.state.now.My[c], -turned.state.now.Mx[q]);
      }
  }
}

TEST(Invariance, ThreadsAndTilesDoNotShow) {
  const auto result = [](int threads, int tile_nx, int tile_ny) {
    force_threads(threads);
    Definition s = release(150, 20, true);
    s.scheme.tile_nx = tile_nx;
    s.scheme.tile_ny = tile_ny;
    Flow run(s);
    run.fill(lump);
    run.to(1.5);
    set_threads(2);
    const Grid& g = run.solver.setup.grid;
    std::vector<double> inside;  // ghosts of sleeping tiles are not kept up to date
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i)
        for (const auto* f : {&run.state.now.D, &run.state.now.Mx, &run.state.now.My})
          inside.push_back((*f)[g.at(i, j)]);
    return inside;
  };
  const auto reference = result(1, 60, 64);
  EXPECT_EQ(result(2, 60, 64), reference);
  EXPECT_EQ(result(2, 13, 7), reference);
  EXPECT_EQ(result(1, 124, 200), reference);
}

TEST(Invariance, CutAndResumedRunsAreTheSame) {
  Flow whole(release(40, 20, true)), cut(release(40, 20, true));
  whole.fill(lump);
  cut.fill(lump);
  whole.to(8);
  cut.to(3);
  Flow resumed(release(40, 20, true));
  resumed.state = cut.state;
  refresh(resumed.solver, resumed.state);
  resumed.to(8);
  EXPECT_EQ(whole.state.step, resumed.state.step);
  const Grid& g = whole.solver.setup.grid;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) ASSERT_EQ(whole.state.now.D[g.at(i, j)], resumed.state.now.D[g.at(i, j)]);
}

TEST(Conservation, MassToRoundOffThroughWallsAndOutflow) {
  for (BoundaryKind kind : {BoundaryKind::wall, BoundaryKind::outflow, BoundaryKind::periodic}) {
    Definition s = release(60, 20, true);
    for (Boundary& b : s.boundary) b.kind = kind;
    Flow run(s);
    run.fill(lump);
    const double start = total_mass(run.solver, run.state);
    run.to(25);
    const double balance = total_mass(run.solver, run.state) + mass_crossed(run.solver, run.state);
    EXPECT_NEAR(balance / start, 1, 1e-13);
    if (kind == BoundaryKind::outflow) {
      EXPECT_GT(mass_crossed(run.solver, run.state) / start, 0.05);
    } else if (kind == BoundaryKind::wall) {
      EXPECT_EQ(mass_crossed(run.solver, run.state), 0);
    }
    for (double D : run.state.now.D) ASSERT_GE(D, 0);
  }
}

TEST(Conservation, InflowHydrograph) {
  Definition s = line(100, 0, 50, 20, coulomb(10));
  s.boundary[0] = {BoundaryKind::inflow, {{0, 2, 4}, {1, 2, 1}, {3, 3, 3}}};
  Flow run(s);
  run.fill([](double, double) { return 0; });
  run.exactly(4);
  const double mass = total_mass(run.solver, run.state);
  EXPECT_NEAR((mass + mass_crossed(run.solver, run.state)) / mass, 0, 1e-13);
  EXPECT_NEAR(mass, 3 * 6, 0.02 * 18);  // supercritical: the flux is h u = 3 (1 .. 2 .. 1), 18 in all
}

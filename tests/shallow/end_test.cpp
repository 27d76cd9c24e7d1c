// How runs end: at a given time exactly, or because everything has left; and what flows in is not stepped over.
#include <gtest/gtest.h>

#include <limits>

#include "shallow/support.hpp"

using namespace shallow_test;

namespace {

Definition slide(int n) {
  Definition s = square(n, 20, 26, coulomb(20), 30);
  s.scheme.dry_depth = 2e-6;
  return s;
}
double heap(double x, double y) { return std::max(0.0, 2 * (1 - (x * x + y * y) / 40)); }

void expect_same_cells(const Flow& a, const Flow& b) {
  const Grid& g = a.solver.setup.grid;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i)
      for (const auto field : {&Conserved::D, &Conserved::Mx, &Conserved::My})
        ASSERT_EQ((a.state.now.*field)[g.at(i, j)], (b.state.now.*field)[g.at(i, j)]) << i << ' ' << j;
}

}  // namespace

TEST(End, IsMetToTheBitHoweverARunIsCut) {
  for (const int n : {1, 24, 60})
    for (const double end : {0.003, 1.0, 4.98, 7.3}) {
      Definition s = n == 1 ? line(50, -20, 20, 26, coulomb(20)) : slide(n);
      Flow whole(s), cut(s);
      whole.fill(heap);
      cut.fill(heap);
      advance(whole.solver, whole.state, end, end);
      for (int k = 1; k < 13; ++k) advance(cut.solver, cut.state, end * k / 13, end);
      Flow resumed(s);
      resumed.state = cut.state;
      refresh(resumed.solver, resumed.state);
      advance(resumed.solver, resumed.state, end, end);
      EXPECT_EQ(whole.state.time, end);
      EXPECT_EQ(resumed.state.time, end);
      EXPECT_EQ(whole.state.step, resumed.state.step);
      expect_same_cells(whole, resumed);
    }
}

// The run that goes on takes the same steps but for the last two, none of which is shorter than half a step.
TEST(End, ShortensTheLastTwoStepsOnly) {
  const double end = 4.98;
  Flow ending(slide(40)), going(slide(40));
  ending.fill(heap);
  going.fill(heap);
  std::vector<double> steps;
  while (ending.state.time < end) {
    const double before = ending.state.time;
    advance_one_step(ending.solver, ending.state, end);
    steps.push_back(ending.state.time - before);
  }
  const std::size_t n = steps.size();
  ASSERT_GT(n, 10u);
  for (std::size_t k = 0; k + 2 < n; ++k) {
    const double before = going.state.time;
    advance_one_step(going.solver, going.state);
    ASSERT_EQ(steps[k], going.state.time - before) << k;
  }
  const double smallest = going.state.smallest_step;
  advance_one_step(going.solver, going.state);
  EXPECT_GE(going.state.time + 1e-12, end - steps[n - 1]);
  EXPECT_NEAR(steps[n - 2], steps[n - 1], 1e-12) << "shared";
  for (const std::size_t k : {n - 2, n - 1}) {
    EXPECT_LE(steps[k], steps[n - 3] * 1.01);
    EXPECT_GE(steps[k], 0.49 * steps[n - 3]);
  }
  EXPECT_EQ(ending.state.smallest_step, smallest);  // dt_min is about the flow, not about the end
}

namespace {

enum class Kind { line, channel, plane, bed, terrain };

// A heap that runs out over `side`, downslope at 25 degrees; frictional, so that nothing stays but films.
Definition draining(Kind kind, Side side, BoundaryKind open) {
  const bool along_x = side == Side::left || side == Side::right;
  const double sign = side == Side::right || side == Side::top ? 1 : -1, steep = tan_d(25);
  const int n = 30;
  const bool one_d = kind == Kind::line || kind == Kind::channel;
  Definition s = one_d ? line(n, -20, 20, 25, coulomb(12)) : square(n, 20, 25, coulomb(12));
  s.gravity.slope_x = along_x ? sign * steep : 0;
  s.gravity.slope_y = along_x ? 0 : sign * steep;
  for (Boundary& b : s.boundary) b.kind = BoundaryKind::wall;
  s.boundary[static_cast<std::size_t>(side)] = {open, {}};
  if (open == BoundaryKind::inflow) s.boundary[static_cast<std::size_t>(side)].inflow = {{0}, {0}, {0}};
  if (kind == Kind::channel)
    for (int f = 0; f <= n; ++f) s.width.push_back(1 + 0.5 * std::sin(0.2 * f));
  if (kind == Kind::bed)
    s.bed = padded_bed(s.grid, [](double x, double y) { return 0.02 * std::sin(x) * std::cos(y); });
  if (kind == Kind::terrain) {
    s.gravity = {.normal = 1, .g = 1};
    s.terrain = true;
    s.bed = padded_bed(s.grid, [&](double x, double y) { return -sign * steep * (along_x ? x : y); });
  }
  s.scheme.dry_depth = 2e-6;
  return s;
}

void expect_all_leave(Kind kind, Side side, BoundaryKind open) {
  SCOPED_TRACE(testing::Message() << static_cast<int>(kind) << ' ' << static_cast<int>(side));
  const double end = 1000;
  Flow run(draining(kind, side, open));
  run.fill(heap);
  const double mass = total_mass(run.solver, run.state);
  while (run.state.time < end && !is_dry(run.solver)) {
    advance_one_step(run.solver, run.state);
    ASSERT_LT(run.state.step, 20000);
  }
  EXPECT_TRUE(is_dry(run.solver));
  EXPECT_LT(run.state.time, 0.2 * end);
  EXPECT_GT(run.state.smallest_step, 1e-3);
  const double steps = static_cast<double>(run.state.step);
  advance(run.solver, run.state, end, end);  // nothing is left to do: at once
  EXPECT_EQ(run.state.time, end);
  EXPECT_LE(static_cast<double>(run.state.step), steps + 2);
  EXPECT_NEAR((total_mass(run.solver, run.state) + mass_crossed(run.solver, run.state)) / mass, 1, 1e-13);
  EXPECT_GT(mass_crossed(run.solver, run.state) / mass, 0.999);
}

}  // namespace

TEST(End, EverythingLeavesThroughAnyOpenSide) {
  for (const BoundaryKind open : {BoundaryKind::outflow, BoundaryKind::inflow}) {  // an inflow that is over
    for (const Kind kind : {Kind::line, Kind::channel})
      for (const Side side : {Side::left, Side::right}) expect_all_leave(kind, side, open);
    for (const Kind kind : {Kind::plane, Kind::bed, Kind::terrain})
      for (const Side side : {Side::left, Side::right, Side::bottom, Side::top}) expect_all_leave(kind, side, open);
  }
}

// Pulses into an empty domain, after silence, shorter than a step would be: what enters is the integral of h u.
TEST(Inflow, PulsesAfterSilenceAreNotSteppedOver) {
  for (const double length : {2.0, 0.1, 1e-3})
    for (const bool from_left : {true, false}) {
      Definition s = line(100, 0, 50, 20, coulomb(10));
      if (!from_left) s.gravity.slope_x *= -1;
      s.scheme.dry_depth = 1e-6;
      const double a = 5, b = 40;  // begin of the pulses
      s.boundary[from_left ? 0 : 1] = {BoundaryKind::inflow,
                                       {{0, a, a + length / 2, a + length, b, b + length / 2, b + length},
                                        {0, 0, 2, 0, 0, 1, 0},
                                        {3, 3, 3, 3, 3, 3, 3}}};
      Flow run(s);
      run.fill([](double, double) { return 0; });
      EXPECT_TRUE(is_dry(run.solver));
      EXPECT_TRUE(more_to_come(run.solver, 0));
      advance(run.solver, run.state, b + 1 + length, b + 1 + length);
      const double in = total_mass(run.solver, run.state) + std::max(0.0, mass_crossed(run.solver, run.state));
      EXPECT_FALSE(more_to_come(run.solver, run.state.time));
      EXPECT_GT(in, 0) << length;
      double entered = 0;
      for (const double m : run.state.crossed[from_left ? 0 : 1]) entered -= m;
      EXPECT_NEAR(entered, 3 * (2 + 1) * length / 2, 0.05 * 3 * 1.5 * length) << length;
      advance(run.solver, run.state, 1e4, 1e4);
      EXPECT_TRUE(is_dry(run.solver));
      EXPECT_EQ(run.state.time, 1e4);
    }
}

// Beside a pile that friction holds lies a dry cell; what trickles into it from the other side is not thrown by the pile.
TEST(Film, IsNotThrownByAPileAtRest) {
  for (const bool mirrored : {false, true})
    for (const double film : {1e-2, 1e-5, 1e-9}) {
      Definition s = line(9, 0, 90, 0, coulomb(20));
      s.scheme.dry_depth = 1e-12;
      Flow run(s);
      const auto cell = [&](int i) { return mirrored ? 8 - i : i; };
      for (int i = 0; i < 4; ++i) set_cell(run.solver, run.state, cell(i), 0, 2);
      for (int i = 5; i < 9; ++i) set_cell(run.solver, run.state, cell(i), 0, film, mirrored ? 1 : -1);
      refresh(run.solver, run.state);
      const double head = 1 + 2 * std::sqrt(film);  // of the film: u + 2 sqrt(g h)
      for (int k = 0; k < 20; ++k) {
        advance_one_step(run.solver, run.state);
        const Profile p = run.profile();
        for (const double u : p.u) ASSERT_LE(std::abs(u), head) << film << ' ' << k;
      }
      EXPECT_NEAR(run.profile().h[static_cast<std::size_t>(cell(0))], 2, 1e-12);
    }
}

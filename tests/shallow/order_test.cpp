// Second order on smooth flow: a simple wave before it breaks, along the grid and across it, and the transcritical case
// of problem 14.
#include <gtest/gtest.h>

#include "shallow/support.hpp"

using namespace shallow_test;

namespace {

// Simple wave of the frictionless equations, alpha = 1: u - 2 c = -2 c0 everywhere, so that u and c = sqrt(G h) are constant
// along dx/dt = u + c = 3 c - 2 c0. s: coordinate along the wave, of period 1.
double simple_wave_c(double s, double t, double c0, double amplitude) {
  double c = c0;
  for (double last = 0; std::abs(c - last) > 1e-14;) {  // contracts before the wave breaks
    last = c;
    c = c0 * (1 + amplitude * std::sin(2 * std::numbers::pi * (s - (3 * c - 2 * c0) * t)));
  }
  return c;
}

double simple_wave_error(int n, bool diagonal) {
  const double G = 1, c0 = 1, amplitude = 0.1, t = 0.25, q = 1 / std::sqrt(2.0), length = diagonal ? std::sqrt(2.0) : 1;
  Definition s = diagonal ? square(n, 0.5 * length, 0, coulomb(0)) : line(n, 0, 1, 0, coulomb(0));
  for (Boundary& b : s.boundary) b.kind = BoundaryKind::periodic;
  const auto along = [&](double x, double y) { return diagonal ? q * (x + y) : x; };
  const auto c_at = [&](double x, double y, double at) { return simple_wave_c(along(x, y), at, c0, amplitude); };
  Flow run(s);
  const double share = diagonal ? q : 1;
  // cell means of the conserved numbers to fourth order, by Simpson's rule
  const Grid& g = run.solver.setup.grid;
  const auto mean = [&](int i, int j, auto&& f) {
    double sum = 0;
    for (int b = -1; b <= 1; ++b)
      for (int a = -1; a <= 1; ++a)
        sum += (a == 0 ? 4 : 1) * (b == 0 ? 4 : 1) / 36.0 *
               f(g.x(i) + 0.5 * a * g.dx, diagonal ? g.y(j) + 0.5 * b * g.dy : 0.0);
    return sum;
  };
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const double h = mean(i, j, [&](double x, double y) { return c_at(x, y, 0) * c_at(x, y, 0) / G; });
      const double m =
          mean(i, j, [&](double x, double y) { return c_at(x, y, 0) * c_at(x, y, 0) / G * 2 * (c_at(x, y, 0) - c0); });
      set_cell(run.solver, run.state, i, j, h, m / h * share, diagonal ? m / h * share : 0);
    }
  refresh(run.solver, run.state);
  run.exactly(t);
  double error = 0, size = 0;
  for (int j = 0; j < g.ny; ++j) {
    const Profile p = run.profile(j);
    for (int i = 0; i < g.nx; ++i) {
      const double exact = mean(i, j, [&](double x, double y) { return c_at(x, y, t) * c_at(x, y, t) / G; });
      error += std::abs(p.h[static_cast<std::size_t>(i)] - exact);
      size += exact;
    }
  }
  return error / size;
}

// Problem 14 from sub- to supercritical flow: h falls smoothly, the bed carries it.
double transcritical_error(int n, double* froude_in, double* froude_out) {
  auto set = *closure::builtin("weinhart2012/1", 1, 6 / std::numbers::pi);
  set.static_branch = {};
  const double theta = 25, length = 600, middle = 250, width = 35, gc = std::cos(rad(theta)), T = tan_d(theta);
  Definition s = line(n, 0, length, theta, set);
  const PreparedClosure p = prepare(s);
  const auto h_of = [&](double x) { return 9.5 - 2.5 * std::tanh((x - middle) / width); };
  const CarriedByItsBed flow{p, h_of, closure_at(p, 9.5, 2.5).rho * 9.5 * 2.5, T, gc};
  const auto u_of = [&](double h) { return flow.u_of(h); };
  *froude_in = u_of(h_of(0)) / std::sqrt(gc * h_of(0));
  *froude_out = u_of(h_of(length)) / std::sqrt(gc * h_of(length));
  constexpr int fine = 8000;
  const double step = (length + 40) / fine, begin = -20;
  std::vector<double> b(fine + 1, 0.0);
  for (int k = 0; k < fine; ++k)
    b[static_cast<std::size_t>(k) + 1] =
        b[static_cast<std::size_t>(k)] + flow.bed_slope(begin + (k + 0.5) * step) * step;
  s.bed = padded_bed(s.grid, [&](double x, double) {
    const double at = std::min(std::max((x - begin) / step, 0.0), fine - 1.0);
    const auto k = static_cast<std::size_t>(at);
    return b[k] + (at - static_cast<double>(k)) * (b[k + 1] - b[k]);
  });
  s.boundary[0] = {BoundaryKind::inflow, {{0}, {h_of(0)}, {u_of(h_of(0))}}};
  Flow run(s);
  run.fill([&](double x, double) { return h_of(x); }, [&](double x, double) { return u_of(h_of(x)); });
  run.to(200);
  const Profile q = run.profile();
  std::vector<double> exact;
  for (double x : q.x) exact.push_back(h_of(x));
  return relative_l1(q.h, exact);
}

}  // namespace

TEST(Order, SimpleWaveAlongTheGrid) {
  const double e1 = simple_wave_error(50, false), e2 = simple_wave_error(100, false),
               e4 = simple_wave_error(200, false);
  tabulate("smooth simple wave 1D", "L1(h) at 200 cells", e4, "< 2e-4");
  tabulate("smooth simple wave 1D", "order", order(e2, e4), ">= 1.9");
  EXPECT_LT(e4, 2e-4);
  EXPECT_GE(order(e1, e2), 1.8);
  EXPECT_GE(order(e2, e4), 1.9);
}

TEST(Order, SimpleWaveAcrossTheGrid) {
  const double e1 = simple_wave_error(32, true), e2 = simple_wave_error(64, true), e4 = simple_wave_error(128, true);
  tabulate("smooth simple wave 2D at 45 deg", "L1(h) at 128^2", e4, "< 5e-4");
  tabulate("smooth simple wave 2D at 45 deg", "order", order(e2, e4), ">= 1.9");
  EXPECT_LT(e4, 5e-4);
  EXPECT_GE(order(e1, e2), 1.8);
  EXPECT_GE(order(e2, e4), 1.9);
}

TEST(Problem14, TranscriticalInverseSteadyStateWithEveryClosure) {
  double in = 0, out = 0;
  const double e1 = transcritical_error(75, &in, &out), e2 = transcritical_error(150, &in, &out),
               e4 = transcritical_error(300, &in, &out);
  EXPECT_LT(in, 0.7);
  EXPECT_GT(out, 1.1);
  tabulate("14 inverse transcritical", "L1(h) at 300 cells", e4, "< 2e-4");
  tabulate("14 inverse transcritical", "order", order(e2, e4), ">= 1.9");
  EXPECT_LT(e4, 2e-4);
  EXPECT_GE(order(e1, e4, 4), 1.9) << e1 << ' ' << e2 << ' ' << e4;
}

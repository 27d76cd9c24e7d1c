// Problems 3, 4, 5, 7, 8, 14: smooth solutions, uniform layers.
#include <gtest/gtest.h>

#include "shallow/support.hpp"

using namespace shallow_test;

namespace {

// 3. Parabolic cap of Savage & Hutter 1989 on an incline; from rest, exact while it spreads everywhere.
struct Cap {
  double H, L, G, m;
  double g_of(double t) const {
    double lo = 1, hi = 1e4;
    for (int k = 0; k < 200; ++k) {
      const double g = 0.5 * (lo + hi), at = L / (2 * std::sqrt(G * H)) *
                                             (std::sqrt(g * (g - 1)) + std::log(std::sqrt(g) + std::sqrt(g - 1)));
      (at < t ? lo : hi) = g;
    }
    return 0.5 * (lo + hi);
  }
};

double cap_error(int n, double t) {
  const double theta = 32, delta = 12, gc = std::cos(rad(theta));
  const Cap cap{0.3, 3, gc, gc * (tan_d(theta) - tan_d(delta))};
  Flow run(line(n, -6, 14, theta, coulomb(delta)));
  run.fill([&](double x, double) { return std::max(0.0, cap.H * (1 - x * x / (cap.L * cap.L))); });
  run.exactly(t);
  const double g = cap.g_of(t), centre = 0.5 * cap.m * t * t;
  const Profile p = run.profile();
  std::vector<double> exact;
  for (double x : p.x) {
    const double r = (x - centre) / (cap.L * g);
    exact.push_back(std::max(0.0, cap.H / g * (1 - r * r)));
  }
  return relative_l1(p.h, exact);
}

// 5. Thacker's planar oscillation in a parabolic bowl.
double thacker_error(int n, double K) {
  const double h0 = 1, a = 3, B = 0.5, G = K, omega = std::sqrt(2 * G * h0) / a, period = 2 * std::numbers::pi / omega;
  Definition s = line(n, -6, 6, 0, coulomb(0, 1, K));
  s.bed = padded_bed(s.grid, [&](double x, double) { return K * h0 * (x * x / (a * a) - 1); });
  Flow run(s);
  const auto exact = [&](double x, double t) {
    const double r = x / a + B / std::sqrt(2 * G * h0) * std::cos(omega * t);
    return std::max(0.0, h0 * (1 - r * r));
  };
  run.fill([&](double x, double) { return exact(x, 0); });
  run.exactly(period);
  const Profile p = run.profile();
  std::vector<double> e;
  for (double x : p.x) e.push_back(exact(x, period));
  return relative_l1(p.h, e);
}

closure::ClosureSet flow_rule(double alpha = 1) {
  closure::ClosureSet set = coulomb(0, alpha);
  set.friction = laws::PouliquenForterre{};
  return set;
}

}  // namespace

TEST(Problem03, ParabolicCap) {
  const double e1 = cap_error(200, 5), e2 = cap_error(400, 5), e4 = cap_error(800, 5);
  tabulate("3 parabolic cap", "L1(h) at 800 cells", e4, "< 2e-3");
  tabulate("3 parabolic cap", "order", order(e2, e4), ">= 0.9");
  EXPECT_LT(e4, 2e-3);
  EXPECT_GE(order(e1, e4, 4), 0.9);
}

TEST(Problem04, RadialCap) {
  const double H = 1, L = 1, t = 1.5;
  std::vector<double> errors;
  for (int n : {50, 100, 200}) {
    Flow run(square(n, 4, 0, coulomb(0)));
    run.fill([&](double x, double y) { return std::max(0.0, H * (1 - (x * x + y * y) / (L * L))); });
    run.exactly(t);
    const double g = std::sqrt(1 + 2 * H * t * t / (L * L));
    double error = 0, size = 0;
    for (int j = 0; j < n; ++j) {
      const Profile p = run.profile(j);
      const double y = run.solver.setup.grid.y(j);
      for (std::size_t i = 0; i < p.x.size(); ++i) {
        const double r2 = (p.x[i] * p.x[i] + y * y) / (L * L * g * g), e = std::max(0.0, H / (g * g) * (1 - r2));
        error += std::abs(p.h[i] - e);
        size += e;
      }
    }
    errors.push_back(error / size);
  }
  tabulate("4 radial cap", "L1(h) at 200^2", errors[2], "< 1e-2");
  tabulate("4 radial cap", "order", order(errors[0], errors[2], 4), ">= 0.9");
  EXPECT_LT(errors[2], 1e-2);
  EXPECT_GE(order(errors[0], errors[2], 4), 0.9);
}

TEST(Problem05, ThackerBowlAfterOnePeriod) {
  for (double K : {1.0, 0.9}) {
    const double e1 = thacker_error(100, K), e4 = thacker_error(400, K);
    tabulate("5 Thacker", "L1(h) at 400 cells", e4, "< 5e-3");
    tabulate("5 Thacker", "order", order(e1, e4, 4), ">= 1.3");
    EXPECT_LT(e4, 5e-3) << K;
    EXPECT_GE(order(e1, e4, 4), 1.3) << K;
  }
}

// 7. A uniform layer under eq. 37: exact time at which the Froude number reaches a value; observed order in dt.
TEST(Problem07, UniformLayerUnderTheFlowRule) {
  const double theta = 24, h = 12, F0 = 0.05, gc = std::cos(rad(theta)), T = tan_d(theta);
  const laws::PouliquenForterre law;
  const double d1 = tan_d(law.delta1_deg), d2 = tan_d(law.delta2_deg), a = law.beta * h / (law.A * law.d);
  const double p = (T - d1) * a, r = d2 - T, Y0 = F0 + law.gamma;
  const auto time_of = [&](double F) {
    const double Y = F + law.gamma;
    return std::sqrt(h / gc) * (-(Y - Y0) / r - (a / r + p / (r * r)) * std::log((p - r * Y) / (p - r * Y0)));
  };
  const double F_end = 0.7 * (law.beta * h / laws::stopping_height(law, theta) - law.gamma), t_end = time_of(F_end);
  std::vector<double> errors;
  for (int steps : {20, 40, 80}) {
    Definition s = line(8, 0, 1000, theta, flow_rule());
    s.boundary[0].kind = s.boundary[1].kind = BoundaryKind::periodic;
    s.scheme.max_step = t_end / steps;
    Flow run(s);
    run.fill([&](double, double) { return h; }, [&](double, double) { return F0 * std::sqrt(gc * h); });
    run.state.next_step = t_end / steps;
    for (int k = 0; k < steps; ++k) advance_one_step(run.solver, run.state);
    ASSERT_NEAR(run.state.time, t_end, 1e-9 * t_end);
    errors.push_back(std::abs(run.profile().u[0] / std::sqrt(gc * h) - F_end));
  }
  tabulate("7 uniform layer", "error of F at 80 steps", errors[2], "< 1e-4");
  tabulate("7 uniform layer", "order in dt", order(errors[1], errors[2]), ">= 1.9");
  EXPECT_LT(errors[2], 1e-4);
  EXPECT_GE(order(errors[1], errors[2]), 1.9);
}

TEST(Problem07, SteadyUniformFlowStaysForAnyStep) {
  const double theta = 24, h = 8, gc = std::cos(rad(theta));
  const laws::PouliquenForterre law;
  const double u = (law.beta * h / laws::stopping_height(law, theta) - law.gamma) * std::sqrt(gc * h);
  Definition s = line(8, 0, 1e6, theta, flow_rule());
  s.boundary[0].kind = s.boundary[1].kind = BoundaryKind::periodic;
  Flow run(s);
  run.fill([&](double, double) { return h; }, [&](double, double) { return u; });
  run.to(1e6);  // dt ~ 1e4 sqrt(h/g)
  EXPECT_NEAR(run.profile().u[3] / u, 1, 1e-10);
  EXPECT_NEAR(run.profile().h[3], h, 1e-12);
}

// 8. Coulomb: stops at t = u0/|m| after u0^2/(2|m|), exactly, and then stays.
TEST(Problem08, CoulombLayerStops) {
  const double theta = 15, delta = 25, u0 = 2, gc = std::cos(rad(theta)), m = gc * (tan_d(theta) - tan_d(delta));
  Definition s = line(8, 0, 8, theta, coulomb(delta));
  s.boundary[0].kind = s.boundary[1].kind = BoundaryKind::periodic;
  s.scheme.max_step = 0.01;
  Flow run(s);
  run.fill([](double, double) { return 1; }, [&](double, double) { return u0; });
  double travelled = 0, stopped = 0;
  while (!at_rest(run.solver, run.state)) {
    const double before = run.profile().u[0], t = run.state.time;
    advance_one_step(run.solver, run.state);
    travelled += 0.5 * (before + run.profile().u[0]) * (run.state.time - t);
    stopped = run.state.time;
  }
  EXPECT_NEAR(stopped, -u0 / m, 0.02);
  EXPECT_NEAR(travelled, -u0 * u0 / (2 * m), 1e-3);
  tabulate("8 stopping", "error of distance", travelled + u0 * u0 / (2 * m), "< 1e-3");
  const std::vector<double> D = run.state.now.D;
  run.to(2 * stopped);
  EXPECT_EQ(run.state.now.D, D);
  EXPECT_TRUE(at_rest(run.solver, run.state));
}

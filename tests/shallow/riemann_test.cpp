// Problems 1, 2, 9 of the verification sheet: dam breaks and jumps in one dimension.
#include <gtest/gtest.h>

#include "shallow/support.hpp"

using namespace shallow_test;

namespace {

// 1. Mangeney, Heinrich & Roche 2000: frictional dam break on an incline, alpha = K = 1, dam at x = 0.
double dam_break_error(int n, double* front) {
  const double theta = 30, delta = 20, h0 = 10, t = 8, gc = std::cos(rad(theta));
  const double m = gc * (tan_d(theta) - tan_d(delta)), c0 = std::sqrt(gc * h0);
  Flow run(line(n, -60, 60, theta, coulomb(delta)));
  run.fill([&](double x, double) { return x < 0 ? h0 : 0; });
  run.exactly(t);
  const auto exact = [&](double x) {
    if (x < (m * t / 2 - c0) * t) return h0;
    if (x > (2 * c0 + m * t / 2) * t) return 0.0;
    const double s = 2 * c0 - x / t + m * t / 2;
    return s * s / (9 * gc);
  };
  const Profile p = run.profile();
  double error = 0, size = 0;
  *front = -60;
  for (std::size_t i = 0; i < p.x.size(); ++i) {
    if (p.h[i] > 1e-3 * h0) *front = p.x[i];
    if (p.x[i] < -25) continue;  // the left end feeds a wave that has not come further
    error += std::abs(p.h[i] - exact(p.x[i]));
    size += exact(p.x[i]);
  }
  return error / size;
}

double stoker_error(int n) {
  const double hl = 1, hr = 0.1, hm = 0.3961748, um = 0.7411516, s = 0.9913929, t = 1;
  Flow run(line(n, -2, 2, 0, coulomb(0)));
  run.fill([&](double x, double) { return x < 0 ? hl : hr; });
  run.exactly(t);
  const Profile p = run.profile();
  std::vector<double> exact;
  for (double x : p.x) {
    const double c = (2 * std::sqrt(hl) - x / t) / 3;
    exact.push_back(x < -t ? hl : x < (um - std::sqrt(hm)) * t ? c * c : x < s * t ? hm : hr);
  }
  return relative_l1(p.h, exact);
}

}  // namespace

TEST(Problem01, CoulombDamBreakOnAnIncline) {
  double front1 = 0, front2 = 0;
  const double e1 = dam_break_error(300, &front1), e2 = dam_break_error(600, &front2),
               e4 = dam_break_error(1200, &front2);
  tabulate("1 dam break", "L1(h) at 1200 cells", e4, "< 2e-3");
  tabulate("1 dam break", "order", order(e2, e4), ">= 0.9");
  EXPECT_LT(e4, 2e-3);
  EXPECT_GE(order(e1, e2), 0.85);
  EXPECT_GE(order(e2, e4), 0.9);
  const double gc = std::cos(rad(30)), m = gc * (tan_d(30) - tan_d(20)), c0 = std::sqrt(10 * gc);
  const double thin = (2 * c0 + m * 4) * 8 - 8 * std::sqrt(9 * gc * 0.01);  // where the exact h is 1e-3 h0
  EXPECT_NEAR(front2, thin, 0.03 * thin);
}

TEST(Problem02, StokerWetDamBreak) {
  const double e1 = stoker_error(200), e4 = stoker_error(800);
  tabulate("2 Stoker", "L1(h) at 800 cells", e4, "< 2e-3");
  tabulate("2 Stoker", "order", order(e1, e4, 4), ">= 0.9");
  EXPECT_LT(e4, 2e-3);
  EXPECT_GE(order(e1, e4, 4), 0.9);
}

TEST(Problem09, StationaryJumpWithShapeFactorAndStressRatio) {
  const double alpha = 1.25, K = 1.05, F1 = 2.5;
  const double ratio = 0.5 * (-1 + std::sqrt(1 + 8 * alpha * F1 * F1 / K));
  EXPECT_NEAR(ratio, 3.389852, 1e-6);
  // upstream h = 1, u = F1 (g = 1) enters on the left; the jump starts at x = 0 and must stay
  Definition s = line(400, -5, 5, 0, coulomb(0, alpha, K));
  s.boundary[0] = {BoundaryKind::inflow, {{0}, {1}, {F1}}};
  s.boundary[1] = {BoundaryKind::inflow, {{0}, {ratio}, {-F1 / ratio}}};
  Flow run(s);
  run.fill([&](double x, double) { return x < 0 ? 1 : ratio; },
           [&](double x, double) { return x < 0 ? F1 : F1 / ratio; });
  run.exactly(20);
  const Profile p = run.profile();
  EXPECT_NEAR(p.h[100], 1, 1e-10);
  EXPECT_NEAR(p.h[300] / ratio, 1, 1e-3);
  double position = 0;
  for (double h : p.h) position += (h < 0.5 * (1 + ratio) ? 1 : 0) * s.grid.dx;
  EXPECT_NEAR(position, 5, 3 * s.grid.dx);
  tabulate("9 stationary jump", "h2/h1 - 3.389852", p.h[300] - ratio, "< 3e-3");
}

TEST(Problem09, MovingBore) {
  const double alpha = 1.25, K = 1.05, h1 = 1, u1 = 0.4, h2 = 2;  // g = 1
  // s [h] = [hu], s [hu] = [alpha h u^2 + K h^2/2]: quadratic for u2, the root of the right-going bore
  const auto f = [&](double u2) {
    const double sp = (h2 * u2 - h1 * u1) / (h2 - h1);
    return sp * (h2 * u2 - h1 * u1) - (alpha * (h2 * u2 * u2 - h1 * u1 * u1) + 0.5 * K * (h2 * h2 - h1 * h1));
  };
  double lo = u1, hi = 5;
  for (int k = 0; k < 200; ++k) (f(0.5 * (lo + hi)) < 0 ? lo : hi) = 0.5 * (lo + hi);
  const double u2 = lo, speed = (h2 * u2 - h1 * u1) / (h2 - h1);
  ASSERT_GT(u2, u1);
  std::vector<double> errors;
  for (int n : {200, 400, 800}) {
    Definition s = line(n, -2, 8, 0, coulomb(0, alpha, K));
    s.boundary[0] = {BoundaryKind::inflow, {{0}, {h2}, {u2}}};
    Flow run(s);
    run.fill([&](double x, double) { return x < 0 ? h2 : h1; }, [&](double x, double) { return x < 0 ? u2 : u1; });
    run.exactly(2);
    const Profile p = run.profile();
    std::vector<double> exact;
    for (double x : p.x) exact.push_back(x < 2 * speed ? h2 : h1);
    errors.push_back(relative_l1(p.h, exact));
  }
  tabulate("9 moving bore", "L1(h) at 800 cells", errors[2], "< 2e-3");
  tabulate("9 moving bore", "order", order(errors[0], errors[2], 4), ">= 0.9");
  EXPECT_LT(errors[2], 2e-3);
  EXPECT_GE(order(errors[0], errors[2], 4), 0.9);
}

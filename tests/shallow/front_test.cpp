// Problem 11: the front of a steady flow over a dry rough plane (Pouliquen 1999; Saingier et al. 2016).
#include <gtest/gtest.h>

#include <array>

#include "shallow/support.hpp"

using namespace shallow_test;

namespace {

// The nose of a front that travels at the velocity U of the uniform flow behind it, by the ODE of u = U:
// dh/dx = (tan(theta) - mu(h, U))/(K + (alpha - 1 + h alpha') U^2/(gc h)), from the tip upstream.
struct Nose {
  double U = 0, dx = 0.02;
  std::vector<double> h;  // at distances k dx behind the tip
  double at(double distance) const {
    if (distance <= 0) return 0;
    const double k = distance / dx;
    const auto i = static_cast<std::size_t>(k);
    return i + 1 < h.size() ? h[i] + (k - static_cast<double>(i)) * (h[i + 1] - h[i]) : h.back();
  }
};

struct Front {
  double theta = 25, depth = 10, alpha = 1, K = 1, tip_depth = 0;
};

Nose integrate(const Front& f, double length) {
  const laws::PouliquenForterre law;
  const double gc = std::cos(rad(f.theta)), T = tan_d(f.theta);
  Nose nose;
  nose.U = (law.beta * f.depth / laws::stopping_height(law, f.theta) - law.gamma) * std::sqrt(gc * f.depth);
  const auto p = law.prepared(1);
  const auto rise = [&](double h) {  // upstream
    const double x = f.tip_depth > 0 ? std::min(1.0, h / f.tip_depth) : 1, extra = f.alpha - 1;
    const double shape = extra * x * x * (3 - 2 * x) + (f.tip_depth > 0 ? extra * 6 * x * x * (1 - x) : 0);
    return (p.mu(h, nose.U / std::sqrt(gc * h)) - T) / (f.K + shape * nose.U * nose.U / (gc * h));
  };
  for (double h = 1e-9, x = 0; x < length; x += nose.dx) {
    nose.h.push_back(h);
    h += nose.dx * rise(h + 0.5 * nose.dx * rise(h));
  }
  return nose;
}

struct Errors {
  double shape, position, speed;  // L1 of h; where h = 0.5, against the ODE, in cells; its mean speed over U, less 1
};

// Starts from the nose with its tip at x = 150 and lets it run 200 long.
Errors travel(const Front& f, int n) {
  const double x0 = 150, t_end = 150;
  const Nose nose = integrate(f, 500);
  closure::ClosureSet set = coulomb(0, f.alpha, f.K);
  set.friction = laws::PouliquenForterre{};
  Definition s = line(n, 0, 500, f.theta, set);
  s.scheme.tip_depth = f.tip_depth;
  Hydrograph& feed = s.boundary[0].inflow;
  s.boundary[0].kind = BoundaryKind::inflow;
  for (int k = 0; k <= 200; ++k) {
    feed.t.push_back(t_end * k / 200);
    feed.h.push_back(nose.at(x0 + nose.U * feed.t.back()));
    feed.u.push_back(nose.U);
  }
  Flow run(s);
  run.fill([&](double x, double) { return nose.at(x0 - x); }, [&](double x, double) { return x < x0 ? nose.U : 0; });
  const auto position = [&] {
    const Profile p = run.profile();
    std::size_t i = p.h.size() - 2;
    while (p.h[i] < 0.5) --i;
    return p.x[i] + (p.h[i] - 0.5) / (p.h[i] - p.h[i + 1]) * s.grid.dx;
  };
  run.exactly(0.4 * t_end);
  const double middle = position();
  run.exactly(t_end);
  const Profile p = run.profile();
  std::vector<double> exact;
  for (double x : p.x) exact.push_back(nose.at(x0 + nose.U * t_end - x));
  double half = 0;  // where the nose is 0.5 thick
  while (nose.at(half) < 0.5) half += 1e-3;
  return {relative_l1(p.h, exact), (position() - (x0 + nose.U * t_end - half)) / s.grid.dx,
          (position() - middle) / (0.6 * t_end * nose.U) - 1};
}

}  // namespace

TEST(Problem11, TravellingFrontKeepsTheShapeAndSpeedOfItsOde) {
  for (const Front& f : {Front{}, Front{.alpha = 1.25, .K = 1.05, .tip_depth = 3}}) {
    std::array<Errors, 3> e;
    for (std::size_t k = 0; k < 3; ++k) e[k] = travel(f, 125 << k);
    const std::string name = f.alpha == 1 ? "11 front" : "11 front alpha 1.25 K 1.05";
    tabulate(name, "L1(h) at 500 cells", e[2].shape, "< 5e-5");
    tabulate(name, "order", order(e[0].shape, e[2].shape, 4), ">= 1.3");
    tabulate(name, "speed/U - 1 at 500 cells", e[2].speed, "< 5e-4");
    EXPECT_LT(e[2].shape, 5e-5) << f.alpha;
    EXPECT_GE(order(e[0].shape, e[2].shape, 4), 1.3) << f.alpha;
    for (const Errors& each : e) {
      EXPECT_LT(std::abs(each.position), 0.5) << f.alpha;
      EXPECT_LT(std::abs(each.speed), 1e-3) << f.alpha;
    }
    EXPECT_LT(std::abs(e[2].speed), 5e-4) << f.alpha;
  }
}

// alpha = 1: the tip has the slope (tan(theta) - tan(delta2))/K.
TEST(Problem11, SlopeOfTheTip) {
  const Nose nose = integrate({}, 10);
  EXPECT_NEAR(nose.at(0.2) / 0.2, tan_d(32.78) - tan_d(25), 0.01);
}

// Released as a step, the layer first collapses like a dam and its front runs ahead of U; then it forgets how it began.
TEST(Problem11, TheFrontOfAStepSettlesToTheSpeedOfTheFlowBehindIt) {
  const Front f;
  const double U = integrate(f, 1).U;
  closure::ClosureSet set = coulomb(0);
  set.friction = laws::PouliquenForterre{};
  Definition s = line(900, 0, 900, f.theta, set);
  s.boundary[0] = {BoundaryKind::inflow, {{0}, {f.depth}, {U}}};
  Flow run(s);
  run.fill([&](double x, double) { return x < 250 ? f.depth : 0; }, [&](double x, double) { return x < 250 ? U : 0; });
  const auto front = [&](double t) {
    run.exactly(t);
    const Profile p = run.profile();
    std::size_t i = p.h.size() - 1;
    while (p.h[i] < 0.5) --i;
    return p.x[i] + (p.h[i] - 0.5) / (p.h[i] - p.h[i + 1]) * s.grid.dx;
  };
  const double x0 = front(5), x1 = front(60), x2 = front(250), x3 = front(400);
  EXPECT_GT((x1 - x0) / 55, 1.3 * U);
  EXPECT_NEAR((x3 - x2) / 150, U, 2e-3 * U);
  tabulate("11 front from a step", "speed/U - 1 for t = 250 ... 400", (x3 - x2) / 150 / U - 1, "< 2e-3");
}

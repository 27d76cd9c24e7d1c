// Metric and curvature of real terrain: a film too thin to push moves like a point mass on the surface z = b(x, y),
//   d(u_i)/dt = -(g + b_jk u_j u_k) b_i/(1 + |grad b|^2) - mu N u_i/|U|,  N = (g + b_jk u_j u_k)/sqrt(1 + |grad b|^2),
// with (u, v) the horizontal part of the velocity U along the surface. Integrated here for every point on its own.
#include <gtest/gtest.h>

#include <array>

#include "shallow/support.hpp"

using namespace shallow_test;

namespace {

struct Surface {
  double height, bx, by, bxx, bxy, byy;
};
using Shape = Surface (*)(double x, double y);

Surface saddle_valley(double x, double y) {
  return {0.10 * x * x + 0.15 * x * y + 0.2 * y * y - 0.3 * x + 0.05 * std::sin(x + 2 * y),
          0.20 * x + 0.15 * y - 0.3 + 0.05 * std::cos(x + 2 * y),
          0.15 * x + 0.4 * y + 0.1 * std::cos(x + 2 * y),
          0.20 - 0.05 * std::sin(x + 2 * y),
          0.15 - 0.1 * std::sin(x + 2 * y),
          0.4 - 0.2 * std::sin(x + 2 * y)};
}
Surface hills(double x, double) {
  return {-0.4 * x + 0.3 * std::sin(x), -0.4 + 0.3 * std::cos(x), 0, -0.3 * std::sin(x), 0, 0};
}

struct Point {
  double x, y, u, v;
};

Point slide(Shape shape, Point p, double mu, double t) {
  const auto rate = [&](const Point& q) {
    const Surface s = shape(q.x, q.y);
    const double bend = 1 + s.bxx * q.u * q.u + 2 * s.bxy * q.u * q.v + s.byy * q.v * q.v;  // g = 1
    const double J2 = 1 + s.bx * s.bx + s.by * s.by, w = s.bx * q.u + s.by * q.v;
    const double drag = mu * bend / std::sqrt(J2) / std::sqrt(q.u * q.u + q.v * q.v + w * w);
    return Point{q.u, q.v, -bend * s.bx / J2 - drag * q.u, -bend * s.by / J2 - drag * q.v};
  };
  const auto moved = [](const Point& a, const Point& k, double dt) {
    return Point{a.x + dt * k.x, a.y + dt * k.y, a.u + dt * k.u, a.v + dt * k.v};
  };
  constexpr int steps = 400;
  const double dt = t / steps;
  for (int k = 0; k < steps; ++k) {
    const Point k1 = rate(p), k2 = rate(moved(p, k1, dt / 2)), k3 = rate(moved(p, k2, dt / 2)),
                k4 = rate(moved(p, k3, dt));
    for (const auto& [slope, weight] : {std::pair{k1, 1.0}, {k2, 2.0}, {k3, 2.0}, {k4, 1.0}})
      p = moved(p, slope, dt * weight / 6);
  }
  return p;
}

// Mean error of the velocity, over its mean, where points that started within `inner` of the centre have come to.
double film_error(Shape shape, int n, bool two_d, double delta_deg, double inner) {
  const double half = 3, t = 0.8, u0 = 0.9, v0 = two_d ? -0.4 : 0;
  Definition s = two_d ? square(n, half, 0, coulomb(delta_deg)) : line(n, -half, half, 0, coulomb(delta_deg));
  s.gravity = {.normal = 1, .g = 1};
  s.terrain = true;
  s.scheme.dry_depth = 1e-14;
  s.bed = padded_bed(s.grid, [&](double x, double y) { return shape(x, two_d ? y : 0).height; });
  Flow run(s);
  run.fill([](double, double) { return 1e-9; }, [&](double, double) { return u0; }, [&](double, double) { return v0; });
  run.exactly(t);
  const Grid& g = run.solver.setup.grid;
  std::vector<Profile> rows;
  double error = 0, size = 0;
  const auto velocity = [&](double x, double y) {  // bilinear
    const double fi = (x - g.x(0)) / g.dx, fj = two_d ? (y - g.y(0)) / g.dy : 0;
    const int i = static_cast<int>(fi), j = static_cast<int>(fj);
    std::array<double, 2> out{};
    for (int b = 0; b <= (two_d ? 1 : 0); ++b)
      for (int a = 0; a <= 1; ++a) {
        const double weight = (a == 1 ? fi - i : 1 - (fi - i)) * (!two_d ? 1 : b == 1 ? fj - j : 1 - (fj - j));
        const CellView c = view_cell(run.solver, run.state, i + a, j + b);
        out[0] += weight * c.u;
        out[1] += weight * c.v;
      }
    return out;
  };
  constexpr int points = 15;
  for (int b = 0; b < (two_d ? points : 1); ++b)
    for (int a = 0; a < points; ++a) {
      const double x = inner * (2.0 * a / (points - 1) - 1), y = two_d ? inner * (2.0 * b / (points - 1) - 1) : 0;
      const Point end = slide(shape, {x, y, u0, v0}, tan_d(delta_deg), t);
      const auto found = velocity(end.x, end.y);
      error += std::hypot(found[0] - end.u, found[1] - end.v);
      size += std::hypot(end.u, end.v);
    }
  return error / size;
}

void expect_second_order(const char* name, Shape shape, bool two_d, double delta_deg) {
  const int n = two_d ? 32 : 100;
  const double inner = 1.2, e1 = film_error(shape, n, two_d, delta_deg, inner),
               e4 = film_error(shape, 4 * n, two_d, delta_deg, inner);
  tabulate(name, "error of velocity on the fine grid", e4, "< 2e-3");
  tabulate(name, "order", order(e1, e4, 4), ">= 1.8");
  EXPECT_LT(e4, 2e-3) << name;
  EXPECT_GE(order(e1, e4, 4), 1.8) << name << ' ' << e1 << ' ' << e4;
}

// A heap sliding down a plane knows nothing of its chart: terrain of constant slope against the incline's own coordinates.
double chart_difference(int n) {
  const double theta = 28, c = std::cos(rad(theta)), t = 6;
  const auto lump = [](double s) { return std::max(0.0, 1 - s * s / 9); };  // s: along the plane
  Definition plane = line(n, -10, 30, theta, coulomb(18, 1.1));
  Definition ground = line(n, -10 * c, 30 * c, 0, coulomb(18, 1.1));
  ground.gravity = {.normal = 1, .g = 1};
  ground.terrain = true;
  ground.bed = padded_bed(ground.grid, [&](double x, double) { return -x * tan_d(theta); });
  for (Definition* d : {&plane, &ground}) d->scheme.tip_depth = 0.1;
  Flow a(plane), b(ground);
  a.fill([&](double x, double) { return lump(x); });
  b.fill([&](double x, double) { return lump(x / c); });
  a.exactly(t);
  b.exactly(t);
  Profile p = a.profile(), q = b.profile();
  EXPECT_NEAR(total_mass(b.solver, b.state) / total_mass(a.solver, a.state), 1, 1e-12);
  const double thickness = relative_l1(q.h, p.h);
  for (std::size_t i = 0; i < p.u.size(); ++i) {  // momentum along the plane
    p.u[i] *= p.h[i];
    q.u[i] *= q.h[i] / c;
  }
  return std::max(thickness, relative_l1(q.u, p.u));
}

}  // namespace

TEST(Metric, FrictionlessFilmSlidesOverHillsLikeAPointMass) { expect_second_order("metric 1D", hills, false, 0); }
TEST(Metric, CoulombFilmFeelsTheCurvatureInItsFriction) {
  expect_second_order("metric 1D with friction", hills, false, 20);
}
TEST(Metric, FrictionlessFilmOnASurfaceBentInBothDirections) {
  expect_second_order("metric 2D", saddle_valley, true, 0);
}
TEST(Metric, CoulombFilmOnASurfaceBentInBothDirections) {
  expect_second_order("metric 2D with friction", saddle_valley, true, 20);
}

TEST(Metric, APlaneAsTerrainIsThePlaneAsAnIncline) {
  const double e1 = chart_difference(200), e2 = chart_difference(400);
  tabulate("metric plane", "L1 of h and hu between the charts at 400 cells", e2, "< 2e-3");
  EXPECT_LT(e2, 2e-3);
  EXPECT_LT(e2, 0.6 * e1);
}

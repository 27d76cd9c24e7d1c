// An oblique collision of two unlike spinning grains, against an integration of the equations of motion written out
// here with Runge-Kutta and a step 400 times shorter; and what no collision may change.
#include <gtest/gtest.h>

#include <algorithm>

#include "dem/contacts.hpp"
#include "helpers.hpp"
#include "laws/contact/pair.hpp"

namespace bagnold::dem {
namespace {
using testing::add_grain;
using testing::paper_laws;

constexpr double tc = 0.005;

struct Pair {  // both grains and the spring, as one point of phase space
  Vec3 x1, x2, v1, v2, w1, w2, spring;
};
Pair operator+(const Pair& a, const Pair& b) {
  return {a.x1 + b.x1, a.x2 + b.x2, a.v1 + b.v1, a.v2 + b.v2, a.w1 + b.w1, a.w2 + b.w2, a.spring + b.spring};
}
Pair operator*(double s, const Pair& a) {
  return {s * a.x1, s * a.x2, s * a.v1, s * a.v2, s * a.w1, s * a.w2, s * a.spring};
}

struct Bodies {
  double r1 = 0.5, r2 = 0.35, m1 = 1, m2 = 0.343;
  double kn = 2e5, gn = 25, kt = 4e5 / 7, gt = 25, mu = 0.5;
};

struct Acting {
  Vec3 force, torque1, torque2, spring_rate, slid_spring;
  double overlap;
};

Acting acting(const Bodies& b, const Pair& s) {
  const Vec3 r = s.x1 - s.x2, n = r / norm(r);
  const double overlap = b.r1 + b.r2 - norm(r);
  const Vec3 arm1 = -(b.r1 - overlap / 2) * n, arm2 = (b.r2 - overlap / 2) * n;
  const Vec3 v = s.v1 - s.v2;
  const Vec3 slip = v - dot(v, n) * n + cross(s.w1, arm1) - cross(s.w2, arm2);
  const double fn = b.kn * overlap - b.gn * dot(v, n);
  Vec3 ft = -b.kt * s.spring - b.gt * slip, slid = s.spring;
  if (norm(ft) > b.mu * std::abs(fn)) {
    ft = b.mu * std::abs(fn) / norm(ft) * ft;
    slid = -(ft + b.gt * slip) / b.kt;
  }
  const Vec3 f = fn * n + ft;
  return {f, cross(arm1, f), cross(arm2, -f), slip - dot(s.spring, v) / norm(r) * n, slid, overlap};
}

Pair rate(const Bodies& b, const Pair& s) {
  const Acting a = acting(b, s);
  const double i1 = 0.4 * b.m1 * b.r1 * b.r1, i2 = 0.4 * b.m2 * b.r2 * b.r2;
  return {s.v1, s.v2, a.force / b.m1, -a.force / b.m2, a.torque1 / i1, a.torque2 / i2, a.spring_rate};
}

Pair reference_collision(const Bodies& b, Pair s) {
  const double h = tc / 20000;
  do {
    const Pair k1 = rate(b, s), k2 = rate(b, s + 0.5 * h * k1), k3 = rate(b, s + 0.5 * h * k2),
               k4 = rate(b, s + h * k3);
    s = s + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    s.spring = acting(b, s).slid_spring;
  } while (acting(b, s).overlap > 0);
  return s;
}

// Just touching, approaching at about 1.
Pair initial(const Bodies& b) {
  const Vec3 n = Vec3{1, 2, -2} / 3.0;
  return {(b.r1 + b.r2) * n, {}, {-0.3, -0.4, 0.5}, {0.1, 0.4, 0.05}, {1, -2, 0.5}, {0.3, 1.5, -0.7}, {}};
}

DemState engine_state(const Bodies& b, const Pair& s, double dt) {
  DemState e;
  e.dt = dt;
  const double density = 6 / std::numbers::pi;
  add_grain(e, s.x1, s.v1, s.w1, 2 * b.r1, density);
  add_grain(e, s.x2, s.v2, s.w2, 2 * b.r2, density);
  return e;
}

class Oblique : public ::testing::TestWithParam<double> {};

TEST_P(Oblique, ConvergesToTheReference) {
  const Bodies b{.mu = GetParam()};
  const Pair start = initial(b), end = reference_collision(b, start);
  const auto laws = paper_laws(b.gn, b.mu);
  for (const int steps : {50, 200, 800}) {
    DemState s = engine_state(b, start, tc / steps);
    prepare(s, laws);
    advance(s, laws, 2 * steps);
    ASSERT_TRUE(contacts(s, laws).empty());
    const double error = std::max({norm(full_step_velocity(s, 0) - end.v1), norm(full_step_velocity(s, 1) - end.v2),
                                   norm(full_step_omega(s, 0) - end.w1), norm(full_step_omega(s, 1) - end.w2)});
    EXPECT_LT(error, 1.5 / steps) << "mu = " << b.mu << ", tc/" << steps;
    RecordProperty("error" + std::to_string(steps), std::to_string(error));
  }
}
INSTANTIATE_TEST_SUITE_P(SlidingMixedSticking, Oblique, ::testing::Values(0.1, 0.5, INFINITY));

TEST(PairOfGrains, MomentumAndAngularMomentumAreKept) {
  for (const double mu : {0.1, 0.5, 20.0}) {
    const Bodies b{.mu = mu};
    DemState s = engine_state(b, initial(b), tc / 50);
    const auto laws = paper_laws(b.gn, b.mu);
    const auto momenta = [&] {
      Vec3 p, l;
      for (std::int64_t i = 0; i < 2; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const Vec3 mv = s.grains.mass[k] * full_step_velocity(s, i);
        p += mv;
        l += cross(s.grains.x[k], mv) + s.grains.inertia[k] * full_step_omega(s, i);
      }
      return std::pair{p, l};
    };
    prepare(s, laws);
    const auto [p0, l0] = momenta();
    for (int n = 0; n < 30; ++n) {
      advance(s, laws, 5);
      const auto [p, l] = momenta();
      EXPECT_LT(norm(p - p0), 1e-12);
      EXPECT_LT(norm(l - l0), 1e-12);
    }
  }
}

TEST(PairOfGrains, RigidRotationHasNoSlip) {
  const Vec3 spin{0.7, -1.1, 2.3}, x1{0.31, 0.2, 0.11}, x2{-0.2, 0.05, -0.3};
  const double r1 = 0.4, r2 = 0.36;
  const laws::PairMotion<double> motion{numbers(x1 - x2),
                                        numbers(cross(spin, x1) - cross(spin, x2)),
                                        numbers(2 * spin),
                                        {0, 0, 0},
                                        r1 + r2,
                                        r1 - r2,
                                        1.0};
  const laws::PairGeometry<double> g = laws::pair_geometry(motion);
  EXPECT_GT(g.overlap, 0);
  EXPECT_LT(norm(vec3(g.slip)), 1e-15);
  EXPECT_LT(norm(vec3(g.spin)), 1e-15);
}

}  // namespace
}  // namespace bagnold::dem

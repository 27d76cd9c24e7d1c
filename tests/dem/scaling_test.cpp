// Changing the units by powers of two changes nothing but exponents.
#include <gtest/gtest.h>

#include "dem/contacts.hpp"
#include "helpers.hpp"

namespace bagnold::dem {
namespace {

struct Units {
  double length = 1, time = 1, mass = 1;
};

DemState run(const Units& u, const PairParameters& parameters, bool reorder) {
  DemState s = testing::random_packing(6, 0.95, 11);
  s.walls = {{{0, 0, s.box.origin.z - 0.45}, {0, 0, 1}, 0}};
  s.box.periodic[2] = false;
  s.gravity = {0.4 * u.length / (u.time * u.time), 0, -0.9 * u.length / (u.time * u.time)};
  s.dt = 1e-4 * u.time;
  s.skin = 0.05 * u.length;
  s.reorder_every = reorder ? 60 : 0;
  s.box.origin *= u.length;
  s.box.length *= u.length;
  s.walls[0].point *= u.length;
  Grains& g = s.grains;
  for (std::size_t i = 0; i < g.x.size(); ++i) {
    g.x[i] *= u.length;
    g.v[i] *= u.length / u.time;
    g.omega[i] *= 1 / u.time;
    g.diameter[i] *= u.length;
    g.mass[i] *= u.mass;
    g.inertia[i] *= u.mass * u.length * u.length;
  }
  const ContactLaws laws = compile(uniform_model({"grain"}, parameters), mean_pair_mass(g));
  prepare(s, laws);
  advance(s, laws, 300);
  return s;
}

void expect_same(const Units& u, const DemState& a, const DemState& b) {
  ASSERT_GT(a.rebuilds, 3);
  EXPECT_EQ(a.rebuilds, b.rebuilds);
  EXPECT_EQ(a.pairs.touching, b.pairs.touching);
  const double speed = u.length / u.time, force = u.mass * speed / u.time;
  for (std::size_t i = 0; i < a.grains.x.size(); ++i) {
    EXPECT_EQ(a.grains.id[i], b.grains.id[i]);
    EXPECT_EQ(u.length * a.grains.x[i], b.grains.x[i]);
    EXPECT_EQ(speed * a.grains.v[i], b.grains.v[i]);
    EXPECT_EQ(a.grains.omega[i] / u.time, b.grains.omega[i]);
    EXPECT_EQ(force * a.grains.force[i], b.grains.force[i]);
    EXPECT_EQ(force * u.length * a.grains.torque[i], b.grains.torque[i]);
  }
  for (std::size_t p = 0; p < a.pairs.spring.size(); ++p) EXPECT_EQ(u.length * a.pairs.spring[p], b.pairs.spring[p]);
}

TEST(ScalingOfUnits, LeavesTheBitsOfNondimensionalResults) {
  const Units u{.length = 16, .time = 4, .mass = 64};
  const auto linear = [](const Units& w) {
    laws::Linear law;
    law.collision_time = 0.005 * w.time;
    law.restitution = 0.88;
    return PairParameters{law, laws::LinearHistory{}, laws::SpringSlider{}};
  };
  const auto hertz = [](const Units& w) {
    laws::Hertz law;
    law.young_modulus = 1e6 * w.mass / (w.length * w.time * w.time);
    return PairParameters{law, laws::Mindlin{}, laws::SpringSlider{}};
  };
  expect_same(u, run({}, linear({}), false), run(u, linear(u), false));
  expect_same(u, run({}, hertz({}), true), run(u, hertz(u), true));
}

}  // namespace
}  // namespace bagnold::dem

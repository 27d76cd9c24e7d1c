// Two grains that meet head-on, against Weinhart et al. 2012, eqs 5, 6.
#include <gtest/gtest.h>

#include "helpers.hpp"
#include "laws/contact/collision.hpp"

namespace bagnold::dem {
namespace {
using testing::add_grain;
using testing::paper_laws;

struct Measured {
  double restitution = 0, time = 0;
};

// Relative speed 1; the first contact falls into the step at `phase` (0..1) of it.
Measured head_on(const ContactLaws& laws, double dt, double phase, bool onto_fixed) {
  DemState s;
  s.dt = dt;
  const double approach = onto_fixed ? 1 : 0.5;
  add_grain(s, {0, 0, 1 + (10 + phase) * dt}, {0, 0, -approach});
  add_grain(s, {0, 0, 0}, {0, 0, onto_fixed ? 0 : approach});
  if (onto_fixed) s.grains.flowing = 1;
  prepare(s, laws);
  double contact_steps = 0;
  bool met = false;
  for (int n = 0; n < 1000000; ++n) {
    advance(s, laws, 1);
    const bool touching = s.pairs.touching[0] != 0;
    contact_steps += touching ? 1 : 0;
    if (met && !touching) break;
    met = met || touching;
  }
  const Vec3 v = full_step_velocity(s, 0) - full_step_velocity(s, 1);
  return {v.z, contact_steps * dt};
}

Measured mean_over_phases(double dt, bool onto_fixed) {
  const auto laws = paper_laws();
  Measured mean;
  constexpr int phases = 32;
  for (int k = 0; k < phases; ++k) {
    const Measured m = head_on(laws, dt, (k + 0.5) / phases, onto_fixed);
    mean.restitution += m.restitution / phases;
    mean.time += m.time / phases;
  }
  return mean;
}

TEST(HeadOnPair, MeanRestitutionOverPhasesAtTcOver50) {
  const auto c = laws::collision_of({2e5, 25}, 0.5);
  const Measured mean = mean_over_phases(c.time / 50, false);
  EXPECT_NEAR(mean.restitution, 0.8831, 5e-4);
  for (const double phase : {0.1, 0.5, 0.9})
    EXPECT_NEAR(head_on(paper_laws(), c.time / 50, phase, false).restitution, 0.8831, 3.5e-3);
}

TEST(HeadOnPair, RestitutionAndTimeConvergeWithTheStep) {
  const auto c = laws::collision_of({2e5, 25}, 0.5);
  for (const int steps : {50, 200, 800}) {
    const Measured m = head_on(paper_laws(), c.time / steps, 0.3, false);
    EXPECT_NEAR(m.restitution, c.restitution, 0.17 / steps) << steps;
    EXPECT_NEAR(m.time, c.time, 1.5 * c.time / steps) << steps;
  }
}

TEST(HeadOnPair, FixedPartnerCountsAsInfiniteMass) {
  const auto c = laws::collision_of({2e5, 25}, 1.0);
  const Measured mean = mean_over_phases(c.time / 100, true);
  EXPECT_NEAR(mean.restitution, c.restitution, 5e-4);
  EXPECT_NEAR(mean.time, c.time, 0.01 * c.time);
}

}  // namespace
}  // namespace bagnold::dem

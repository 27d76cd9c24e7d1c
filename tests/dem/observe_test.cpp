// Looking at a flow without taking the grains from the engine.
#include <gtest/gtest.h>

#include <vector>

#include "core/parallel.hpp"
#include "dem/contacts.hpp"
#include "dem/fast/engine.hpp"
#include "dem/observe.hpp"
#include "mixtures.hpp"

namespace bagnold::dem {
namespace {

using testing::bits;
using testing::Mixture;
using testing::mixtures;

DemState over_a_plane(const Mixture& mixture, std::int64_t per_side = 6) {
  DemState s = testing::random_packing(per_side, 0.99 - 0.2 * mixture.size_spread, 9, mixture.size_spread);
  for (std::size_t i = 0; i < s.grains.x.size(); ++i)
    s.grains.species[i] = static_cast<std::int32_t>(i) % mixture.species;
  s.grains.flowing -= per_side;
  s.gravity = {0.4, 0, -0.9};
  s.dt = 1e-4;
  s.box.periodic[2] = false;
  s.walls = {{s.box.origin - Vec3{0, 0, 0.4}, {0, 0, 1}, 0}};
  prepare(s, mixture.laws);
  return s;
}

std::vector<double> numbers_of(const Observation& seen) {
  const Energies& e = seen.energies;
  return {e.translational,
          e.rotational,
          e.gravity,
          e.normal_spring,
          e.tangential_spring,
          e.rolling_spring,
          seen.velocity.x,
          seen.velocity.y,
          seen.velocity.z,
          seen.centre_height,
          static_cast<double>(seen.contacts),
          seen.overlap_ratio};
}

TEST(Observation, IsWhatTheStateHolds) {
  for (const Mixture& mixture : mixtures()) {
    DemState s = over_a_plane(mixture);
    for (const int steps : {0, 38, 200}) {
      advance_inside(s, mixture.laws, steps);
      const Observation seen = observe(s, mixture.laws);
      EXPECT_TRUE(s.grains.x.empty());  // nobody has moved a grain
      hand_back(s);
      const Energies e = energies(s, mixture.laws);
      EXPECT_EQ(static_cast<std::size_t>(seen.contacts), contacts(s, mixture.laws).size()) << mixture.name;
      EXPECT_NEAR(seen.overlap_ratio, max_overlap_over_radius(s), 1e-13) << mixture.name;
      const auto expected = numbers_of(observe_plain(s, mixture.laws)), found = numbers_of(seen);
      for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_NEAR(found[k], expected[k], 1e-11 * std::abs(expected[k]) + 1e-11) << mixture.name << ", number " << k;
      EXPECT_NEAR(seen.energies.total(), e.total(), 1e-10 * std::abs(e.total())) << mixture.name;
    }
  }
}

// To the bit: whether the engine has gone on, has given the grains back and taken them again, or starts from a copy of the
// state, on any threads.
TEST(Observation, DependsOnNothingButTheState) {
  const int before = threads();
  for (const Mixture& mixture : {mixtures()[0], mixtures()[6], mixtures()[7]}) {
    DemState inside = over_a_plane(mixture, 10), outside = inside;
    for (const int steps : {3, 90, 61}) {
      set_threads(1);
      advance_inside(inside, mixture.laws, steps);
      const auto expected = numbers_of(observe(inside, mixture.laws));
      advance(outside, mixture.laws, steps);
      EXPECT_EQ(numbers_of(observe(outside, mixture.laws)), expected) << mixture.name;
      hand_back(outside);
      DemState copy = outside;
      set_threads(3);
      EXPECT_EQ(numbers_of(observe(copy, mixture.laws)), expected) << mixture.name;
    }
    hand_back(inside);
    EXPECT_TRUE(bits(inside) == bits(outside)) << mixture.name;
  }
  set_threads(before);
}

// What the engine holds is complete again for whoever needs it.
TEST(Observation, PlainStepsAndNewLawsFindTheGrains) {
  const Mixture mixture = mixtures()[0];
  DemState a = over_a_plane(mixture), b = a;
  advance_inside(a, mixture.laws, 50);
  advance(b, mixture.laws, 50);
  advance_plain(a, mixture.laws, 3);
  advance_plain(b, mixture.laws, 3);
  EXPECT_TRUE(bits(a) == bits(b));
  advance_inside(a, mixture.laws, 20);
  advance(b, mixture.laws, 20);
  const ContactLaws smooth = testing::paper_laws(25, 0);
  a.walls[0].point.z -= 0.001;
  b.walls[0].point.z -= 0.001;
  advance_inside(a, smooth, 20);
  advance(b, smooth, 20);
  hand_back(a);
  EXPECT_TRUE(bits(a) == bits(b));
}

}  // namespace
}  // namespace bagnold::dem

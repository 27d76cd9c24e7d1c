// Planes in the fast engine: the plain engine is the reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "dem/contact_laws.hpp"
#include "dem/contacts.hpp"
#include "dem/fast/engine.hpp"
#include "mixtures.hpp"

namespace bagnold::dem {
namespace {

using testing::bits;
using testing::largest_difference;
using testing::Mixture;
using testing::mixtures;
using testing::random_packing;

// chute: a floor under grains that run along it, periodic in x and y. trough: between a tilted floor, a ceiling and two
// side walls, some grains fixed, periodic in y only.
DemState between_walls(const Mixture& mixture, bool chute, std::int64_t per_side = 6) {
  const double spacing = 0.99 - 0.45 * mixture.size_spread;
  DemState s = random_packing(per_side, spacing, 5, mixture.size_spread);
  Grains& g = s.grains;
  const auto kind = [&](int n) { return static_cast<std::int32_t>(n % mixture.species); };
  for (std::size_t i = 0; i < g.x.size(); ++i) g.species[i] = kind(static_cast<int>(i));
  s.gravity = {0.4, 0.1, -0.9};
  s.dt = 1e-4;
  s.box.periodic[2] = false;
  const Vec3 low = s.box.origin,
             high = low + s.box.length - spacing * Vec3{1, 1, 1};  // grains of the lattice's corners
  if (chute) {
    s.walls = {{low - Vec3{0, 0, 0.44}, {0, 0, 1}, kind(1)}};
    for (Vec3& v : g.v) v += Vec3{6, 0, -0.5};
  } else {
    s.box.periodic[0] = false;
    s.walls = {{low - Vec3{0, 0, 0.46}, Vec3{0.1, 0, 1} / std::sqrt(1.01), kind(1)},
               {high + Vec3{0, 0, 0.42}, {0, 0, -1}, kind(0)},
               {low - Vec3{0.44, 0, 0}, {1, 0, 0}, kind(0)},
               {high + Vec3{0.43, 0, 0}, {-1, 0, 0}, kind(1)}};
    g.flowing -= per_side;
  }
  prepare(s, mixture.laws);
  return s;
}

std::int64_t at_walls(const DemState& s) {
  return std::count(s.wall_contacts.touching.begin(), s.wall_contacts.touching.end(), std::uint8_t{1});
}

TEST(Walls, FastFollowsThePlainEngine) {
  for (const Mixture& mixture : mixtures())
    for (const bool chute : {true, false}) {
      const std::string name = mixture.name + (chute ? ", chute" : ", trough");
      DemState fast = between_walls(mixture, chute), plain = fast;
      ASSERT_TRUE(fast::supports(fast));
      double spring = 0, roll = 0;
      std::int64_t met = 0;
      for (const int steps : {21, 20, 352}) {  // lists are made anew on the way
        advance(fast, mixture.laws, steps);
        advance_plain(plain, mixture.laws, steps);
        met += at_walls(fast);
        EXPECT_NEAR(static_cast<double>(at_walls(fast)), static_cast<double>(at_walls(plain)), 1) << name;
        EXPECT_LT(largest_difference(fast.wall_contacts.spring, plain.wall_contacts.spring), 1e-9) << name;
        EXPECT_LT(largest_difference(fast.wall_contacts.roll, plain.wall_contacts.roll), 1e-8) << name;
        for (const Vec3& v : fast.wall_contacts.spring) spring = std::max(spring, norm(v));
        for (const Vec3& v : fast.wall_contacts.roll) roll = std::max(roll, norm(v));
      }
      EXPECT_GT(fast.rebuilds, 1) << name;
      for (std::size_t i = 0; i < fast.grains.x.size(); ++i)
        EXPECT_LT(norm(minimum_image(fast.box, fast.grains.x[i] - plain.grains.x[i])), 1e-10) << name;
      EXPECT_LT(largest_difference(fast.grains.v, plain.grains.v), 1e-8) << name;
      EXPECT_LT(largest_difference(fast.grains.omega, plain.grains.omega), 1e-8) << name;
      EXPECT_LT(largest_difference(fast.grains.force, plain.grains.force), 1e-5) << name;
      EXPECT_GT(met, 30) << name;
      EXPECT_GT(spring, 1e-6) << name;
      EXPECT_EQ(roll > 1e-6, name.find("rolling") != std::string::npos) << name;
    }
}

// From then on the plain engine finds the springs at walls that the fast one has left, and the other way round.
TEST(Walls, EnginesTakeOverFromEachOther) {
  const Mixture mixture = mixtures()[4];
  DemState a = between_walls(mixture, false), b = a;
  advance(a, mixture.laws, 150);
  advance_plain(a, mixture.laws, 150);
  advance_plain(b, mixture.laws, 150);
  advance(b, mixture.laws, 150);
  for (std::size_t i = 0; i < a.grains.x.size(); ++i)
    EXPECT_LT(norm(minimum_image(a.box, a.grains.x[i] - b.grains.x[i])), 1e-11);
  EXPECT_LT(largest_difference(a.grains.v, b.grains.v), 1e-9);
  EXPECT_LT(largest_difference(a.wall_contacts.spring, b.wall_contacts.spring), 1e-9);
}

TEST(Walls, ForcesAreThoseOfTheContacts) {
  for (const Mixture& mixture : mixtures())
    for (const bool chute : {true, false}) {
      DemState s = between_walls(mixture, chute);
      advance(s, mixture.laws, 41);
      std::vector<Vec3> force(s.grains.x.size());
      std::int64_t met = 0;
      for (const Contact& c : contacts(s, mixture.laws)) {
        force[at(c.i)] += c.force;
        if (c.j >= 0 && c.j < s.grains.flowing) force[at(c.j)] -= c.force;
        if (c.j < 0) ++met;
      }
      double scale = 0;
      for (const Vec3& f : force) scale = std::max(scale, norm(f));
      EXPECT_EQ(met, at_walls(s)) << mixture.name;
      EXPECT_GT(met, 5) << mixture.name;
      EXPECT_LT(largest_difference(force, s.grains.force), 1e-9 * scale) << mixture.name;
    }
}

TEST(Walls, SameBitsWhateverTheThreadsOrTheInterruptions) {
  const int before = threads();
  for (const Mixture& mixture : {mixtures()[0], mixtures()[4], mixtures()[7]})
    for (const bool chute : {true, false}) {
      const DemState start = between_walls(mixture, chute, 13);
      force_threads(1);
      DemState once = start;
      advance(once, mixture.laws, 303);
      const std::string expected = bits(once);
      ASSERT_GT(once.rebuilds, 1);
      for (const int count : {2, 3}) {
        force_threads(count);
        DemState threaded = start;
        advance(threaded, mixture.laws, 303);
        EXPECT_TRUE(bits(threaded) == expected) << mixture.name << ", threads " << count;
      }
      DemState watched = start, resumed = start;
      for (const int steps : {1, 2, 90, 5, 70, 70, 62, 3}) {
        advance(watched, mixture.laws, steps);
        advance(resumed, mixture.laws, steps);
        resumed = DemState(resumed);  // a copy carries the state and nothing else
      }
      EXPECT_TRUE(bits(watched) == expected) << mixture.name;
      EXPECT_TRUE(bits(resumed) == expected) << mixture.name;
    }
  set_threads(before);
}

// Fast grains in a closed box: whoever reaches a wall is seen to, in the step in which it does.
TEST(Walls, NoContactIsEverMissed) {
  const Mixture mixture = mixtures()[1];
  DemState s = random_packing(6, 1.6, 3, 0.4);
  for (std::size_t i = 0; i < s.grains.v.size(); ++i) s.grains.v[i] = (i % 7 == 0 ? 40.0 : 3.0) * s.grains.v[i];
  for (int k = 0; k < 3; ++k) {
    Vec3 inwards;
    inwards[k] = 1;
    s.box.periodic[at(k)] = false;
    s.walls.push_back({s.box.origin - Vec3{1, 1, 1}, inwards, 0});
    s.walls.push_back({s.box.origin + s.box.length - Vec3{0.5, 0.5, 0.5}, -inwards, 0});
  }
  s.dt = 1e-4;
  s.max_overlap_ratio = 0.9;
  prepare(s, mixture.laws);
  std::int64_t met = 0;
  for (int step = 0; step < 1500; ++step) {
    advance(s, mixture.laws, 1);
    std::int64_t touching = 0;
    for (const Wall& wall : s.walls)
      for (std::size_t i = 0; i < s.grains.x.size(); ++i)
        touching += height_above(wall, s.grains.x[i]) < 0.5 * s.grains.diameter[i] * (1 - 1e-14) ? 1 : 0;
    ASSERT_EQ(touching, at_walls(s)) << "step " << step;
    met += touching;
  }
  EXPECT_GT(met, 1000);
}

// A wall that is moved is another wall, and one that is gone holds nothing.
TEST(Walls, EditedWallsAreSeen) {
  const Mixture mixture = mixtures()[0];
  DemState s = between_walls(mixture, true);
  advance(s, mixture.laws, 10);
  s.walls[0].point.z += 0.01;
  DemState copy = s;  // without the engine
  advance(s, mixture.laws, 20);
  advance(copy, mixture.laws, 20);
  EXPECT_TRUE(bits(s) == bits(copy));
}

TEST(Walls, TooDeepAnOverlapNamesTheWall) {
  const Mixture mixture = mixtures()[0];
  DemState s = between_walls(mixture, false);
  s.grains.v[36] = {0, 0, -80};  // in the lowest layer
  s.max_overlap_ratio = 0.25;
  try {
    advance(s, mixture.laws, 100);
    FAIL();
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("overlap with wall 0"), std::string::npos) << error.what();
  }
  EXPECT_FALSE(s.grains.x.empty());
}

}  // namespace
}  // namespace bagnold::dem

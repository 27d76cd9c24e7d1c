// Looking at a run from inside: nobody is disturbed, and what is seen is the state at that step.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <vector>

#include "dem/contacts.hpp"
#include "dem/fast/engine.hpp"
#include "mixtures.hpp"

namespace bagnold::dem {
namespace {

using testing::bits;
using testing::Mixture;
using testing::mixtures;

// Grains over a plane, some of them fixed.
DemState flow(const Mixture& mixture, std::int64_t per_side = 6) {
  DemState s = testing::random_packing(per_side, 0.99 - 0.45 * mixture.size_spread, 11, mixture.size_spread);
  s.grains.flowing -= per_side;
  for (std::size_t i = 0; i < s.grains.x.size(); ++i)
    s.grains.species[i] = static_cast<std::int32_t>(i) % mixture.species;
  s.gravity = {0.4, 0, -0.9};
  s.dt = 1e-4;
  s.box.periodic[2] = false;
  s.walls = {{s.box.origin - Vec3{0, 0, 0.44}, {0, 0, 1}, 0}, {s.box.origin - Vec3{0, 0, 0.42}, {0, 0, 1}, 0}};
  prepare(s, mixture.laws);
  return s;
}

TEST(Watch, SeesTheStepsAskedForAndDisturbsNothing) {
  for (const bool plain : {false, true}) {
    const Mixture mixture = mixtures()[0];
    DemState watched = flow(mixture, plain ? 3 : 6), alone = watched;
    ASSERT_EQ(fast::supports(watched), !plain);
    std::vector<std::int64_t> seen;
    Watch watch{.first = 10, .last = 90, .every = 25};
    watch.plain = [&](const DemState& s) { seen.push_back(s.step); };
    watch.fast = [&](const fast::Engine& engine) { seen.push_back(engine.step); };
    for (const int steps : {9, 1, 30, 80}) advance(watched, mixture.laws, steps, watch);
    advance(alone, mixture.laws, 120);
    EXPECT_EQ(seen, (std::vector<std::int64_t>{10, 35, 60, 85}));
    EXPECT_TRUE(bits(watched) == bits(alone));
  }
}

TEST(Watch, RowsAndContactsAreThoseOfTheState) {
  for (const Mixture& mixture : mixtures()) {
    DemState s = flow(mixture);
    std::vector<Vec3> x, v, force(s.grains.x.size());
    std::map<std::pair<int, int>, std::array<Vec3, 3>> met;  // branch, normal, force; by grains i < j, or wall j
    double overlaps = 0;
    int at_walls = 0;
    Watch watch{.first = 41, .last = 41};
    watch.fast = [&](const fast::Engine& engine) {
      for (std::size_t i = 0; i < force.size(); ++i) {
        const double* at = &engine.rows.position[fast::position_doubles * engine.row[i]];
        x.push_back({at[0], at[1], at[2]});
      }
    };
    watch.fast_contacts = [&](const fast::Engine& engine, std::size_t, fast::ContactPacks packs) {
      for (const fast::ContactPack& pack : packs)
        for (std::size_t k = 0; k < 8; ++k) {
          if ((pack.touching >> k & 1) == 0) continue;
          const auto lane = [k](const fast::ContactPack::Vector& a) { return Vec3{a[0][k], a[1][k], a[2][k]}; };
          const int i = engine.grain[pack.i[k]], j = engine.grain[pack.j[k]];
          const bool as_listed = j < 0 || i < j;  // walls come second
          const double sign = as_listed ? 1 : -1;
          met[as_listed ? std::pair{i, j} : std::pair{j, i}] = {sign * lane(pack.branch), sign * lane(pack.normal),
                                                                sign * lane(pack.force)};
          at_walls += j < 0 ? 1 : 0;
          overlaps += pack.overlap[k];
        }
    };
    advance(s, mixture.laws, 41, watch);
    ASSERT_EQ(x.size(), s.grains.x.size());
    EXPECT_EQ(x, s.grains.x) << mixture.name;
    double scale = 0, expected_overlaps = 0;
    const auto listed = contacts(s, mixture.laws);
    EXPECT_GT(listed.size(), 100u);
    EXPECT_GT(at_walls, 5) << mixture.name;
    EXPECT_EQ(met.size(), listed.size()) << mixture.name;
    for (const Contact& c : listed) scale = std::max(scale, norm(c.force));
    for (const Contact& c : listed) {
      const auto& [branch, normal, push] = met[{c.i, c.j}];
      EXPECT_LT(norm(branch - c.branch), 1e-14) << mixture.name;
      EXPECT_LT(norm(normal - c.normal), 1e-14) << mixture.name;
      EXPECT_LT(norm(push - c.force), 1e-11 * scale) << mixture.name;
      expected_overlaps += c.overlap;
    }
    EXPECT_NEAR(overlaps, expected_overlaps, 1e-12);
  }
}

}  // namespace
}  // namespace bagnold::dem

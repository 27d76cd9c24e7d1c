// Looking at a run from inside: nobody is disturbed, and what is seen is the state at that step.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <vector>

#include "dem/contacts.hpp"
#include "dem/fast/engine.hpp"
#include "helpers.hpp"

namespace bagnold::dem {
namespace {

using testing::bits;
using testing::linear;

struct Material {
  std::string name;
  double size_spread;
  ContactLaws laws;
};

std::vector<Material> materials() {
  const PairParameters paper{linear(2e5, 25), laws::LinearHistory{}, laws::NoRollingResistance{}};
  PairParameters rolling = paper, hertz = paper, softer = paper;
  rolling.rolling = laws::SpringSlider{};
  laws::Hertz normal;
  normal.young_modulus = 5e6;
  normal.restitution = 0.88;
  hertz.normal = normal;
  hertz.tangential = laws::Mindlin{};
  softer.normal = linear(1e5, 10);
  auto two = uniform_model({"a", "b"}, paper);
  set_pair(two, 0, 1, softer);
  const auto one = [](const PairParameters& p) { return compile(uniform_model({"grain"}, p), 0.5); };
  return {{"paper", 0, one(paper)},
          {"hertz, sizes", 0.4, one(hertz)},
          {"rolling", 0.3, one(rolling)},
          {"species", 0, compile(two, 0.5)}};
}

DemState flow(const Material& material) {
  DemState s = testing::random_packing(6, 0.99 - 0.45 * material.size_spread, 11, material.size_spread);
  s.grains.flowing -= 6;
  if (material.name == "species")
    for (std::size_t i = 0; i < s.grains.x.size(); i += 2) s.grains.species[i] = 1;
  s.gravity = {0.4, 0, -0.9};
  s.dt = 1e-4;
  prepare(s, material.laws);
  return s;
}

TEST(Watch, SeesTheStepsAskedForAndDisturbsNothing) {
  for (const bool plain : {false, true}) {
    const Material material = materials()[0];
    DemState watched = flow(material), alone = watched;
    watched.keep_ledger = alone.keep_ledger = plain;  // which only the plain engine can do
    std::vector<std::int64_t> seen;
    Watch watch{.first = 10, .last = 90, .every = 25};
    watch.plain = [&](const DemState& s) { seen.push_back(s.step); };
    watch.fast = [&](const fast::Engine& engine) { seen.push_back(engine.step); };
    for (const int steps : {9, 1, 30, 80}) advance(watched, material.laws, steps, watch);
    advance(alone, material.laws, 120);
    EXPECT_EQ(seen, (std::vector<std::int64_t>{10, 35, 60, 85}));
    EXPECT_TRUE(bits(watched) == bits(alone));
  }
}

TEST(Watch, RowsAndContactsAreThoseOfTheState) {
  for (const Material& material : materials()) {
    DemState s = flow(material);
    std::vector<Vec3> x, v, force(s.grains.x.size());
    std::map<std::pair<int, int>, std::array<Vec3, 3>> met;  // branch, normal, force; by grains i < j
    double overlaps = 0;
    Watch watch{.first = 321, .last = 321};
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
          const double sign = i < j ? 1 : -1;
          met[{std::min(i, j), std::max(i, j)}] = {sign * lane(pack.branch), sign * lane(pack.normal),
                                                   sign * lane(pack.force)};
          overlaps += pack.overlap[k];
        }
    };
    advance(s, material.laws, 321, watch);
    ASSERT_EQ(x.size(), s.grains.x.size());
    EXPECT_EQ(x, s.grains.x) << material.name;
    double scale = 0, expected_overlaps = 0;
    const auto listed = contacts(s, material.laws);
    EXPECT_GT(listed.size(), 100u);
    EXPECT_EQ(met.size(), listed.size()) << material.name;
    for (const Contact& c : listed) scale = std::max(scale, norm(c.force));
    for (const Contact& c : listed) {
      const auto& [branch, normal, push] = met[{c.i, c.j}];
      EXPECT_LT(norm(branch - c.branch), 1e-14) << material.name;
      EXPECT_LT(norm(normal - c.normal), 1e-14) << material.name;
      EXPECT_LT(norm(push - c.force), 1e-11 * scale) << material.name;
      expected_overlaps += c.overlap;
    }
    EXPECT_NEAR(overlaps, expected_overlaps, 1e-12);
  }
}

}  // namespace
}  // namespace bagnold::dem

// The energy ledger of the fast engine: that of the plain one to round-off, closed, and of no influence.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/parallel.hpp"
#include "core/variant.hpp"
#include "dem/contacts.hpp"
#include "dem/fast/engine.hpp"
#include "mixtures.hpp"

namespace bagnold::dem {
namespace {

using testing::bits;
using testing::Mixture;
using testing::mixtures;
using testing::random_packing;

// Grains shaken between a floor and fixed grains, sliding along both; periodic in x and y.
DemState shaken(const Mixture& mixture, double dt, std::int64_t per_side = 6) {
  DemState s = random_packing(per_side, 0.99 - 0.45 * mixture.size_spread, 7, mixture.size_spread);
  Grains& g = s.grains;
  for (std::size_t i = 0; i < g.x.size(); ++i) g.species[i] = static_cast<std::int32_t>(i) % mixture.species;
  for (Vec3& v : g.v) v += Vec3{2, 0, 0};
  g.flowing -= per_side;
  s.gravity = {0.4, 0, -0.9};
  s.dt = dt;
  s.box.periodic[2] = false;
  s.walls = {{s.box.origin - Vec3{0, 0, 0.44}, {0, 0, 1}, mixture.species - 1}};
  s.keep_ledger = true;
  prepare(s, mixture.laws);
  return s;
}

std::array<double, 9> parts(const Ledger& l) {
  return {l.damped.normal, l.damped.tangential, l.damped.rolling, l.power.normal, l.power.tangential,
          l.power.rolling, l.sliding,           l.roll_sliding,   l.opened};
}

TEST(FastLedger, IsThatOfThePlainEngine) {
  for (const Mixture& mixture : mixtures()) {
    DemState fast = shaken(mixture, 1e-4), plain = fast;
    ASSERT_TRUE(fast::supports(fast));
    for (const int steps : {1, 60, 239}) {
      advance(fast, mixture.laws, steps);
      advance_plain(plain, mixture.laws, steps);
      const auto a = parts(fast.ledger), b = parts(plain.ledger);
      for (std::size_t k = 0; k < a.size(); ++k) {
        const double scale = std::max(std::abs(b[k]), 1e-6 * lost(plain.ledger));
        EXPECT_NEAR(a[k], b[k], (steps == 239 ? 1e-6 : 1e-9) * scale) << mixture.name << ", part " << k;
      }
    }
    const bool rolls = mixture.name.find("rolling") != std::string::npos;
    const auto a = parts(fast.ledger);
    for (const std::size_t k : {0, 1, 6, 8}) EXPECT_GT(a[k], 1e-4 * lost(fast.ledger)) << mixture.name << k;
    for (const std::size_t k : {2, 7}) EXPECT_EQ(a[k] > 1e-5 * lost(fast.ledger), rolls) << mixture.name << k;
  }
}

// The initial power, before any step.
TEST(FastLedger, StartsWithThePowerOfTheDashpots) {
  for (const Mixture& mixture : mixtures()) {
    DemState s = shaken(mixture, 1e-4);
    const Ledger fast = s.ledger;
    balance_ledger(s, mixture.laws);
    EXPECT_NEAR(fast.power.normal, s.ledger.power.normal, 1e-11 * s.ledger.power.normal) << mixture.name;
    EXPECT_NEAR(fast.power.tangential, s.ledger.power.tangential, 1e-11 * s.ledger.power.tangential) << mixture.name;
    EXPECT_GT(fast.power.normal, 0) << mixture.name;
    EXPECT_EQ(fast.damped.normal, 0);
  }
}

TEST(FastLedger, Closes) {
  for (const Mixture& mixture : mixtures()) {
    std::vector<double> residuals;
    for (const int per_collision : {50, 200}) {
      DemState s = shaken(mixture, 0.005 / per_collision);
      const double first = energies(s, mixture.laws).total() + lost(s.ledger);
      advance(s, mixture.laws, 8 * per_collision);
      EXPECT_GT(lost(s.ledger), 10);
      residuals.push_back(std::abs(energies(s, mixture.laws).total() + lost(s.ledger) - first) / lost(s.ledger));
    }
    EXPECT_LT(residuals[0], 6e-3) << mixture.name;  // Hertz contacts lose most while they stiffen
    EXPECT_LT(residuals[1], residuals[0] / 3) << mixture.name;
  }
}

// Where products and sums are fused the compiler fuses the rolling law another way when the ledger is kept: round-off.
TEST(FastLedger, ChangesNoBitOfTheFlow) {
  for (const Mixture& mixture : mixtures()) {
    DemState with = shaken(mixture, 1e-4), without = with;
    without.keep_ledger = false;
    advance(with, mixture.laws, 203);
    advance(without, mixture.laws, 203);
    EXPECT_LT(testing::largest_difference(with.grains.x, without.grains.x), 1e-12) << mixture.name;
    EXPECT_LT(testing::largest_difference(with.grains.v, without.grains.v), 1e-9) << mixture.name;
  }
  const WithVariant unfused(built_variants().front());
  for (const Mixture& mixture : mixtures()) {
    DemState with = shaken(mixture, 1e-4), without = with;
    without.keep_ledger = false;
    advance(with, mixture.laws, 203);
    advance(without, mixture.laws, 203);
    EXPECT_GT(lost(with.ledger), 0);
    with.ledger = without.ledger = {};
    EXPECT_TRUE(bits(with) == bits(without)) << mixture.name;
  }
}

TEST(FastLedger, HasTheSameBitsWhateverTheThreadsOrTheInterruptions) {
  const int before = threads();
  for (const Mixture& mixture : {mixtures()[0], mixtures()[6], mixtures()[7]}) {
    const DemState start = shaken(mixture, 1e-4, 13);
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
    Watch watch{.first = 1, .last = 300, .every = 7};
    watch.fast_contacts = [](const fast::Engine&, std::size_t, fast::ContactPacks) {};
    watch.fast = [](const fast::Engine&) {};
    for (const int steps : {1, 2, 90, 5, 70, 70, 62, 3}) {
      advance(watched, mixture.laws, steps, watch);
      advance(resumed, mixture.laws, steps);
      resumed = DemState(resumed);  // a copy carries the state and nothing else
    }
    EXPECT_TRUE(bits(watched) == expected) << mixture.name;
    EXPECT_TRUE(bits(resumed) == expected) << mixture.name;
  }
  set_threads(before);
}

}  // namespace
}  // namespace bagnold::dem

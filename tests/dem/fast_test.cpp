// The fast engine against the plain one, and against itself: no contact missed, and bits that depend on nothing but
// the input.
#include <algorithm>
#include <functional>
#include <vector>

#include "core/parallel.hpp"
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

// Grains shaken in a periodic box, some of them fixed, driven by an oblique gravity.
DemState dense_flow(const Mixture& mixture, std::int64_t per_side = 6) {
  DemState s = random_packing(per_side, 0.99 - 0.45 * mixture.size_spread, 11, mixture.size_spread);
  Grains& g = s.grains;
  for (std::size_t i = 0; i < g.x.size(); ++i) g.species[i] = static_cast<std::int32_t>(i) % mixture.species;
  g.flowing -= static_cast<std::int64_t>(per_side);  // the last row is fixed
  s.gravity = {0.4, 0, -0.9};
  s.dt = 1e-4;
  prepare(s, mixture.laws);
  return s;
}

TEST(Fast, FollowsThePlainEngine) {
  for (const Mixture& mixture : mixtures()) {
    DemState fast = dense_flow(mixture), plain = fast;
    ASSERT_TRUE(fast::supports(fast));
    for (int k = 0; k < 3; ++k) {  // 400 steps: neighbours part and meet, round-off has grown little
      advance(fast, mixture.laws, 130 + k);
      advance_plain(plain, mixture.laws, 130 + k);
    }
    for (std::size_t i = 0; i < fast.grains.x.size(); ++i)
      EXPECT_LT(norm(minimum_image(fast.box, fast.grains.x[i] - plain.grains.x[i])), 1e-10) << mixture.name;
    EXPECT_LT(largest_difference(fast.grains.v, plain.grains.v), 1e-8) << mixture.name;
    EXPECT_LT(largest_difference(fast.grains.omega, plain.grains.omega), 1e-8) << mixture.name;
    EXPECT_LT(largest_difference(fast.grains.force, plain.grains.force), 1e-5) << mixture.name;
    const auto a = contacts(fast, mixture.laws), b = contacts(plain, mixture.laws);
    EXPECT_GT(a.size(), 100u) << mixture.name;
    EXPECT_NEAR(static_cast<double>(a.size()), static_cast<double>(b.size()), 1) << mixture.name;
  }
}

// The forces a state carries are those of its contacts, whoever computed them.
TEST(Fast, ForcesAreThoseOfTheContactsAtAnyTime) {
  for (const Mixture& mixture : mixtures()) {
    DemState s = dense_flow(mixture);
    for (int k = 0; k < 6; ++k) {
      advance(s, mixture.laws, 501);
      std::vector<Vec3> force(s.grains.x.size()), torque(s.grains.x.size());
      for (const Contact& c : contacts(s, mixture.laws)) {
        const auto i = static_cast<std::size_t>(c.i), j = static_cast<std::size_t>(c.j);
        force[i] += c.force;
        torque[i] += c.torque;
        if (c.j >= s.grains.flowing) continue;
        force[j] -= c.force;
        torque[j] += c.torque_j;
      }
      double scale = 0;
      for (const Vec3& f : force) scale = std::max(scale, norm(f));
      EXPECT_LT(largest_difference(force, s.grains.force), 1e-9 * scale) << mixture.name;
      // A rolling spring at its limit has no dashpot: rounding decides when it is as good as there.
      const bool rolls = mixture.name.find("rolling") != std::string::npos;
      EXPECT_LT(rolls ? 0 : largest_difference(torque, s.grains.torque), 1e-9 * scale) << mixture.name;
    }
  }
}

TEST(Fast, SameBitsWhateverTheThreadsTheOutputOrTheInterruptions) {
  const int before = threads();
  for (const Mixture& mixture : {mixtures()[0], mixtures()[4]}) {
    const DemState start = dense_flow(mixture, 17);  // four thousand grains: several blocks of slabs
    force_threads(1);
    DemState once = start;
    advance(once, mixture.laws, 403);
    const std::string expected = bits(once);
    ASSERT_GT(once.rebuilds, 1);

    for (const int count : {2, 3}) {
      force_threads(count);
      DemState threaded = start;
      advance(threaded, mixture.laws, 403);
      EXPECT_TRUE(bits(threaded) == expected) << mixture.name << ", threads " << count;
    }
    DemState watched = start, resumed = start;
    for (const int steps : {1, 2, 150, 5, 90, 90, 62, 3}) {
      advance(watched, mixture.laws, steps);
      advance(resumed, mixture.laws, steps);
      resumed = DemState(resumed);  // a copy carries the state and nothing else
    }
    EXPECT_TRUE(bits(watched) == expected) << mixture.name;
    EXPECT_TRUE(bits(resumed) == expected) << mixture.name;
  }
  set_threads(before);
}

// Fast dilute grains with a few violent encounters: the bounds that let pairs be skipped are tested hardest.
TEST(Fast, NoContactIsEverMissed) {
  const Mixture mixture = mixtures()[1];
  DemState s = random_packing(6, 2.1, 3, 0.4);
  for (std::size_t i = 0; i < s.grains.v.size(); ++i) s.grains.v[i] = (i % 7 == 0 ? 60.0 : 3.0) * s.grains.v[i];
  s.dt = 1e-4;
  s.max_overlap_ratio = 1.9;
  prepare(s, mixture.laws);
  std::size_t met = 0;
  for (int step = 0; step < 1500; ++step) {
    advance(s, mixture.laws, 1);
    const Grains& g = s.grains;
    std::size_t touching = 0;
    for (std::size_t i = 0; i < g.x.size(); ++i)
      for (std::size_t j = i + 1; j < g.x.size(); ++j) {
        const double reach = 0.5 * (g.diameter[i] + g.diameter[j]);
        const Vec3 r = g.x[i] - g.x[j];
        if (std::abs(r.x) < reach || std::abs(r.x) > s.box.length.x - reach)
          touching += norm2(minimum_image(s.box, r)) < reach * reach * (1 - 1e-14) ? 1 : 0;
      }
    const auto listed = std::count(s.pairs.touching.begin(), s.pairs.touching.end(), std::uint8_t{1});
    ASSERT_EQ(touching, static_cast<std::size_t>(listed)) << "step " << step;
    met += touching;
  }
  EXPECT_GT(met, 1000u);
}

TEST(Fast, EditedStatesAreSeen) {
  const Mixture mixture = mixtures()[0];
  DemState s = dense_flow(mixture);
  advance(s, mixture.laws, 10);
  DemState edited = s;
  s.grains.v[3].x += 1;  // the engine of s is still there, that of the copy is not
  edited.grains.v[3].x += 1;
  advance(s, mixture.laws, 10);
  advance(edited, mixture.laws, 10);
  EXPECT_TRUE(bits(s) == bits(edited));
}

TEST(Fast, PlainEngineGoesOnFromItsState) {
  const Mixture mixture = mixtures()[0];
  DemState a = dense_flow(mixture), b = a;
  advance(a, mixture.laws, 100);
  advance_plain(a, mixture.laws, 100);
  advance_plain(b, mixture.laws, 200);
  EXPECT_LT(largest_difference(a.grains.v, b.grains.v), 1e-9);
}

TEST(Fast, LeavesToThePlainEngineWhatItCannotDo) {
  DemState s = dense_flow(mixtures()[0]);
  EXPECT_TRUE(fast::supports(s));
  s.box.length.x = 2;
  EXPECT_FALSE(fast::supports(s));
  EXPECT_FALSE(fast::supports(random_packing(3, 1, 1)));
}

}  // namespace
}  // namespace bagnold::dem

// The order of steps in a pass over the ring of slabs (dem/fast/sweep.hpp): every step finds what it needs done.
#include "dem/fast/sweep.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace {
using namespace bagnold;
using dem::fast::make_ring;
using dem::fast::Ring;

// f(ring, its slabs, a number) for many of them.
template <class F>
void for_rings(F&& f) {
  std::mt19937 draw(1);
  for (int k = 0; k < 2000; ++k) {
    std::vector<std::size_t> sizes(2 + draw() % 200);
    for (auto& size : sizes) size = draw() % 50;
    f(make_ring(sizes, 1 + static_cast<int>(draw() % 6)), sizes.size(), static_cast<int>(draw() % 1000));
    if (testing::Test::HasFailure()) return;
  }
}

TEST(sweep, blocks_cover_the_ring_and_leave_room_for_their_triangles) {
  for_rings([](const Ring& ring, std::size_t slabs, int) {
    EXPECT_EQ(ring.border.front(), 0);
    EXPECT_EQ(ring.border.back(), static_cast<int>(slabs));
    EXPECT_TRUE(ring.blocks() == 1 || ring.blocks() % 2 == 0);
    for (std::size_t k = 0; k + 1 < ring.border.size(); ++k)
      EXPECT_GE(ring.border[k + 1] - ring.border[k], std::min(static_cast<int>(slabs), 2 * ring.levels));
  });
}

// Move t of a slab needs the forces of step t - 1 from both its sections, the forces of a section at t both its slabs
// moved by t; nothing is done twice or left out, however a pass is cut.
TEST(sweep, every_step_follows_what_it_needs) {
  for_rings([](const Ring& ring, std::size_t slabs, int any) {
    std::vector<int> moved(slabs, 0), acted(slabs, 0);  // steps done
    const auto slab = [&](int a) { return static_cast<std::size_t>(ring.wrap(a)); };
    const auto move = [&](int a, int t) {
      EXPECT_EQ(moved[slab(a)]++, t);
      EXPECT_EQ(acted[slab(a)], t);
      EXPECT_EQ(acted[slab(a - 1)], t);
    };
    const auto act = [&](int a, int t) {
      EXPECT_EQ(acted[slab(a)]++, t);
      EXPECT_EQ(moved[slab(a)], t + 1);
      EXPECT_EQ(moved[slab(a + 1)], t + 1);
    };
    const int cut = any % (ring.levels + 1);
    sweep(ring, 0, cut, false, move, act);
    sweep(ring, cut, ring.levels, false, move, act);
    for (std::size_t a = 0; a < slabs; ++a) EXPECT_TRUE(moved[a] == ring.levels && acted[a] == ring.levels);
  });
}

TEST(sweep, blocks_share_the_grains_not_the_slabs) {
  std::vector<std::size_t> sizes(200, 0);  // an avalanche in the upper part of a long chute
  std::fill_n(sizes.begin(), 100, 30);
  const Ring ring = make_ring(sizes, 4);
  std::size_t most = 0;
  for (std::size_t k = 0; k + 1 < ring.border.size(); ++k)
    most = std::max(most, std::reduce(sizes.begin() + ring.border[k], sizes.begin() + ring.border[k + 1]));
  EXPECT_LE(most, 2 * 3000 / static_cast<std::size_t>(ring.blocks()));
}

}  // namespace

// Settled beds: at rest and whole, whatever the sizes; the same bits everywhere; what stands in for them.
#include "scenario/settled_bed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "scenario/granular.hpp"

namespace bagnold::scenario {
namespace {

BedRecipe small(double spread) {
  BedRecipe recipe;
  recipe.length = recipe.width = 4;
  recipe.thickness = 4;
  recipe.size_spread = spread;
  return recipe;
}

class SettledBed : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Spread, SettledBed, testing::Values(0.0, 0.3, 0.8),
                         [](const auto& p) { return std::to_string(static_cast<int>(10 * p.param)); });

TEST_P(SettledBed, HasNeitherThrownNorPressedItsGrains) {
  const BedRecipe recipe = small(GetParam());
  const auto bed = settle_bed(recipe);
  ASSERT_TRUE(bed);
  ASSERT_EQ(static_cast<std::int64_t>(bed->x.size()), bed_grains(recipe));
  const Box box{{0, 0, 0}, {4, 4, 1}, {true, true, false}};
  double top = 0, volume = 0;
  for (std::size_t i = 0; i < bed->x.size(); ++i) {
    const double d = bed->diameter[i];
    EXPECT_GT(bed->x[i].z, 0.49 * d);
    top = std::max(top, bed->x[i].z + 0.5 * d);
    volume += std::numbers::pi / 6 * d * d * d;
    for (std::size_t j = 0; j < i; ++j) {
      const double gap = norm(minimum_image(box, bed->x[i] - bed->x[j])) - 0.5 * (d + bed->diameter[j]);
      EXPECT_GT(gap, -4e-3);  // a few layers on soft grains
    }
  }
  EXPECT_GT(volume / (16 * top), 0.4);  // lies, with nothing flying about
  EXPECT_LT(volume / (16 * top), 0.74);
}

TEST(Settling, StopsWhenItIsToldTo) {
  int looks = 0;
  EXPECT_FALSE(settle_bed(small(0), [&](const Settling& now) {
    EXPECT_LT(now.time, now.latest);
    return ++looks < 3;
  }));
  EXPECT_EQ(looks, 3);
}

TEST(Settling, DoesNotDependOnBeingWatched) {
  int looks = 0;
  const auto alone = settle_bed(small(0)), watched = settle_bed(small(0), [&](const Settling&) { return ++looks > 0; });
  EXPECT_EQ(alone->x, watched->x);
  EXPECT_GT(looks, 5);
}

// The promise of bed_path(): the bits of a bed are the same on every machine and in every build. A build without
// the baseline variant makes no such promise and says so in the path.
TEST(Settling, GivesTheseBits) {
  const auto bed = settle_bed(small(0.3));
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a, by words
  for (const Vec3& x : bed->x)
    for (const double v : {x.x, x.y, x.z}) hash = (hash ^ std::bit_cast<std::uint64_t>(v)) * 0x100000001b3u;
  EXPECT_EQ(hash, 5674845281427489516u) << "other bits than settle_bed gave when this was written: change bed_path() with it";
}

TEST(StandInBed, CountsLikeASettledOne) {
  BedRecipe recipe;
  recipe.length = recipe.width = 3;
  const Bed guess = stand_in_bed(recipe);
  const auto bed = settle_bed(recipe);
  EXPECT_EQ(guess.x.size(), bed->x.size());
  EXPECT_EQ(guess.diameter, bed->diameter);
  const auto base = static_cast<double>(cut_base(*bed).size());
  EXPECT_NEAR(static_cast<double>(cut_base(guess).size()), base, 0.35 * base);  // seventeen, one by one at random
}

}  // namespace
}  // namespace bagnold::scenario

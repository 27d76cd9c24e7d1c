#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/box.hpp"
#include "core/fields.hpp"
#include "core/memory.hpp"
#include "core/random.hpp"
#include "core/registry.hpp"
#include "core/vec3.hpp"

namespace bagnold {
namespace {

// Known answers of the authors of the generator (Salmon et al. 2011): counter and key all zeros, all ones, digits of pi.
TEST(Random, IsPhilox) {
  using Words = std::array<std::uint32_t, 4>;
  constexpr std::uint32_t ones = 0xffffffff;
  EXPECT_EQ(random::philox(0, {0, 0, 0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(random::philox(~std::uint64_t{0}, {ones, ones, ones, ones}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(random::philox(0x299f31d0a4093822, {0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, IsUniformAndStreamsAreIndependent) {
  constexpr int n = 100'000;
  double sum = 0, squares = 0, product = 0;
  for (std::uint64_t i = 0; i < n; ++i) {
    const double u = random::uniform(7, random::Stream::fill, i), v = random::uniform(7, random::Stream::base, i);
    ASSERT_TRUE(u >= 0 && u < 1);
    sum += u;
    squares += u * u;
    product += (u - 0.5) * (v - 0.5);
  }
  const double five_sigma = 5 / std::sqrt(12.0 * n);
  EXPECT_NEAR(sum / n, 0.5, five_sigma);
  EXPECT_NEAR(squares / n, 1.0 / 3, five_sigma);
  EXPECT_NEAR(product / n, 0, five_sigma / std::sqrt(12.0));
}

TEST(Box, MinimumImageIsTheShortestAndWrapStaysInside) {
  const Box box{.origin = {-1, 2, 0}, .length = {3, 0.7, 1}, .periodic = {true, true, false}};
  for (std::uint64_t k = 0; k < 2000; ++k) {
    const auto [a, b] = random::uniform2(1, random::Stream::test, k);
    const Vec3 r{40 * a - 20, 40 * b - 20, 9 * a};
    const Vec3 inside = wrap(box, r), shortest = minimum_image(box, r);
    EXPECT_EQ(inside.z, r.z);
    for (int d = 0; d < 2; ++d) {
      EXPECT_TRUE(inside[d] >= box.origin[d] && inside[d] < box.origin[d] + box.length[d]);
      EXPECT_LE(std::abs(shortest[d]), 0.5 * box.length[d] * (1 + 1e-12));
      for (const Vec3& image : {inside, shortest}) {  // whole periods away from r
        const double periods = (r[d] - image[d]) / box.length[d];
        EXPECT_NEAR(periods, std::round(periods), 1e-9);
      }
    }
  }
  EXPECT_EQ(wrap(box, {-1 - 1e-17, 2 - 1e-17, 0}),
            (Vec3{-1, 2, 0}));  // a tiny step outside does not land on the far edge
}

TEST(Vec3, AlgebraOfVectorsAndTensors) {
  const Vec3 a{1, 2, 3}, b{-2, 0.5, 4};
  EXPECT_EQ(cross(a, b), (Vec3{6.5, -10, 4.5}));
  EXPECT_EQ(dot(cross(a, b), a), 0);
  EXPECT_EQ(trace(outer(a, b)), dot(a, b));
  EXPECT_EQ(outer(a, b)(0, 2), 4);
  EXPECT_EQ(outer(a, b)(2, 0), -6);
  EXPECT_EQ(norm(Vec3{2, 3, 6}), 7);
}

TEST(Fields, RangesKnowTheirEnds) {
  EXPECT_TRUE(positive().contains(1e-300) && !positive().contains(0) && !positive().contains(-1));
  EXPECT_TRUE(closed(0, 1).contains(0) && closed(0, 1).contains(1) && !open(0, 1).contains(1));
  EXPECT_FALSE(any_number().contains(std::nan("")));
  EXPECT_EQ(to_string(positive()), "> 0");
  EXPECT_EQ(to_string(closed(0, 90)), ">= 0 and <= 90");
  EXPECT_EQ(to_string(any_number()), "any");
}

TEST(Fields, TheNearestKeyIsTheOneMeant) {
  const std::vector<std::string> known{"friction", "stiffness", "restitution", "collision_time"};
  EXPECT_EQ(nearest("fricton", known), "friction");
  EXPECT_EQ(nearest("collisiontime", known), "collision_time");
  EXPECT_EQ(nearest("viscosity_of_water", known), "");
}

struct One {
  static constexpr std::string_view name = "one";
  int value = 1;
};
struct Two {
  static constexpr std::string_view name = "two";
  int value = 2;
};

TEST(Registry, MakesLawsByName) {
  using Laws = Registry<One, Two>;
  EXPECT_EQ(Laws::names(), (std::vector<std::string>{"one", "two"}));
  const auto two = Laws::make("two");
  ASSERT_TRUE(two);
  EXPECT_EQ(name_of(*two), "two");
  EXPECT_EQ(std::get<Two>(*two).value, 2);
  EXPECT_FALSE(Laws::make("three"));
}

TEST(LargePages, SmallArraysFillCacheLinesAndLargeOnesPages) {
  const auto address = [](const auto& a) { return reinterpret_cast<std::uintptr_t>(a.data()); };
  std::vector<std::int32_t, LargePages<std::int32_t>> small(3, 7), large(3 << 20, 7);
  EXPECT_EQ(address(small) % 64, 0u);
  EXPECT_EQ(address(large) % LargePages<std::int32_t>::page, 0u);
  large.resize(5 << 20, 8);
  EXPECT_EQ(std::count(large.begin(), large.end(), 7), 3 << 20);
  EXPECT_EQ(large.back(), 8);
}

}  // namespace
}  // namespace bagnold

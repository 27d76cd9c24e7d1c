// A pack must answer lane by lane what double answers.
#include "core/simd.hpp"

#include <array>
#include <cmath>

#include "core/random.hpp"

namespace bagnold {
namespace {

Pack numbers(std::uint32_t draw, double lo, double hi) {
  Pack p;
  for (int k = 0; k < Pack::lanes; ++k)
    p.set(k, lo + (hi - lo) * random::uniform(7, random::Stream::test, static_cast<std::uint64_t>(k), draw));
  return p;
}

TEST(Simd, ArithmeticIsThatOfEveryLane) {
  const auto a = numbers(1, -3, 5), b = numbers(2, 0.1, 4);
  const auto sum = a + b, difference = a - b, product = a * b, quotient = a / b;
  const auto least = min(a, b), most = max(a, b), magnitude = abs(a);
  for (int k = 0; k < Pack::lanes; ++k) {
    EXPECT_EQ(sum[k], a[k] + b[k]);
    EXPECT_EQ(difference[k], a[k] - b[k]);
    EXPECT_EQ(product[k], a[k] * b[k]);
    EXPECT_EQ(quotient[k], a[k] / b[k]);
    EXPECT_EQ(least[k], std::min(a[k], b[k]));
    EXPECT_EQ(most[k], std::max(a[k], b[k]));
    EXPECT_EQ(magnitude[k], std::fabs(a[k]));
  }
}

TEST(Simd, RootsAreExactToOneUnitInTheLastPlace) {
  for (std::uint32_t draw = 0; draw < 200; ++draw) {
    const double scale = std::pow(10.0, static_cast<double>(draw % 40) - 20);
    const auto a = numbers(draw, 0.5 * scale, 60 * scale), root = sqrt(a), inverse = rsqrt(a);
    for (int k = 0; k < Pack::lanes; ++k) {
      EXPECT_NEAR(root[k] / std::sqrt(a[k]), 1, 2.3e-16);
      EXPECT_NEAR(inverse[k] * std::sqrt(a[k]), 1, 4.5e-16);
      EXPECT_NEAR(reciprocal(a)[k] * a[k], 1, 4.5e-16);
    }
  }
  EXPECT_EQ(sqrt(Pack(0.0))[3], 0);
}

TEST(Simd, LaneSumsAreTheSumsOfTheLanes) {
  const Pack packs[5] = {numbers(1, -3, 5), numbers(2, 0.1, 4), numbers(3, -1, 1), numbers(4, 0, 9), numbers(5, -9, 0)};
  double sums[5];
  lane_sums(packs, sums);
  for (int p = 0; p < 5; ++p) {
    double plain = 0;
    for (int k = 0; k < Pack::lanes; ++k) plain += packs[p][k];
    EXPECT_NEAR(sums[p], plain, 1e-14 * 80);
    EXPECT_NEAR(lane_sum(packs[p]), plain, 1e-14 * 80);
  }
}

TEST(Simd, ComparisonsChooseLanes) {
  const auto a = numbers(3, -1, 1), b = numbers(4, -1, 1);
  const auto chosen = select(a < b, a, Pack(7));
  std::uint32_t expected = 0;
  for (int k = 0; k < Pack::lanes; ++k) {
    EXPECT_EQ(chosen[k], a[k] < b[k] ? a[k] : 7);
    expected |= (a[k] < b[k] ? 1u : 0u) << k;
  }
  EXPECT_EQ(to_integer(a < b), expected);
  EXPECT_EQ(to_integer(b > a), expected);
  EXPECT_FALSE(any(a < a));
  EXPECT_TRUE(any(a < a + Pack(1)));
}

TEST(Simd, NotANumberIsNeverLessAndIsNeverChosenBySelect) {
  const auto nan = Pack(std::nan(""));
  EXPECT_FALSE(any(nan < Pack(1)));
  EXPECT_EQ(select(nan > Pack(0), nan, Pack(2))[0], 2);
}

TEST(Simd, NearestInteger) {
  const auto a = numbers(5, -40, 40), n = nearest_integer(a);
  for (int k = 0; k < Pack::lanes; ++k) EXPECT_EQ(n[k], std::nearbyint(a[k]));
}

TEST(Simd, LoadsWhatItStored) {
  alignas(64) std::array<double, Pack::lanes> memory{};
  const auto a = numbers(6, -1, 1);
  a.store(memory.data());
  const auto b = Pack::load(memory.data());
  for (int k = 0; k < Pack::lanes; ++k) {
    EXPECT_EQ(memory[static_cast<std::size_t>(k)], a[k]);
    EXPECT_EQ(b[k], a[k]);
  }
}

}  // namespace
}  // namespace bagnold

// A pack must answer lane by lane what double answers.
#include "core/simd.hpp"

#include <array>
#include <cmath>

#include "core/random.hpp"

namespace bagnold {
namespace {

template <class P>
class Simd : public testing::Test {};
using Packs = testing::Types<Pack<1>, Pack<2>>;
TYPED_TEST_SUITE(Simd, Packs);

template <class P>
P numbers(std::uint32_t draw, double lo, double hi) {
  P p;
  for (int k = 0; k < P::lanes; ++k)
    p.set(k, lo + (hi - lo) * random::uniform(7, random::Stream::test, static_cast<std::uint64_t>(k), draw));
  return p;
}

TYPED_TEST(Simd, ArithmeticIsThatOfEveryLane) {
  const auto a = numbers<TypeParam>(1, -3, 5), b = numbers<TypeParam>(2, 0.1, 4);
  const auto sum = a + b, difference = a - b, product = a * b, quotient = a / b;
  const auto least = min(a, b), most = max(a, b), magnitude = abs(a);
  for (int k = 0; k < TypeParam::lanes; ++k) {
    EXPECT_EQ(sum[k], a[k] + b[k]);
    EXPECT_EQ(difference[k], a[k] - b[k]);
    EXPECT_EQ(product[k], a[k] * b[k]);
    EXPECT_EQ(quotient[k], a[k] / b[k]);
    EXPECT_EQ(least[k], std::min(a[k], b[k]));
    EXPECT_EQ(most[k], std::max(a[k], b[k]));
    EXPECT_EQ(magnitude[k], std::fabs(a[k]));
  }
}

TYPED_TEST(Simd, RootsAreExactToOneUnitInTheLastPlace) {
  for (std::uint32_t draw = 0; draw < 200; ++draw) {
    const double scale = std::pow(10.0, static_cast<double>(draw % 40) - 20);
    const auto a = numbers<TypeParam>(draw, 0.5 * scale, 60 * scale), root = sqrt(a), inverse = rsqrt(a);
    for (int k = 0; k < TypeParam::lanes; ++k) {
      EXPECT_NEAR(root[k] / std::sqrt(a[k]), 1, 2.3e-16);
      EXPECT_NEAR(inverse[k] * std::sqrt(a[k]), 1, 4.5e-16);
    }
  }
  EXPECT_EQ(sqrt(TypeParam(0.0))[3], 0);
}

TYPED_TEST(Simd, ComparisonsChooseLanes) {
  const auto a = numbers<TypeParam>(3, -1, 1), b = numbers<TypeParam>(4, -1, 1);
  const auto chosen = select(a < b, a, TypeParam(7));
  std::uint32_t expected = 0;
  for (int k = 0; k < TypeParam::lanes; ++k) {
    EXPECT_EQ(chosen[k], a[k] < b[k] ? a[k] : 7);
    expected |= (a[k] < b[k] ? 1u : 0u) << k;
  }
  EXPECT_EQ(to_integer(a < b), expected);
  EXPECT_EQ(to_integer(b > a), expected);
  EXPECT_FALSE(any(a < a));
  EXPECT_TRUE(any(a < a + TypeParam(1)));
}

TYPED_TEST(Simd, NotANumberIsNeverLessAndIsNeverChosenBySelect) {
  const auto nan = TypeParam(std::nan(""));
  EXPECT_FALSE(any(nan < TypeParam(1)));
  EXPECT_EQ(select(nan > TypeParam(0), nan, TypeParam(2))[0], 2);
}

TYPED_TEST(Simd, NearestInteger) {
  const auto a = numbers<TypeParam>(5, -40, 40), n = nearest_integer(a);
  for (int k = 0; k < TypeParam::lanes; ++k) EXPECT_EQ(n[k], std::nearbyint(a[k]));
}

TYPED_TEST(Simd, LoadsWhatItStored) {
  alignas(64) std::array<double, TypeParam::lanes> memory{};
  const auto a = numbers<TypeParam>(6, -1, 1);
  a.store(memory.data());
  const auto b = TypeParam::load(memory.data());
  for (int k = 0; k < TypeParam::lanes; ++k) {
    EXPECT_EQ(memory[static_cast<std::size_t>(k)], a[k]);
    EXPECT_EQ(b[k], a[k]);
  }
}

}  // namespace
}  // namespace bagnold

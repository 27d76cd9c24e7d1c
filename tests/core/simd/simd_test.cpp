// A pack must answer lane by lane what double answers, whatever registers it lies in.
#include "core/simd.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.hpp"

namespace bagnold {
namespace {

Pack numbers(std::uint32_t draw, double lo, double hi) {
  Pack p = 0.0;
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

TEST(Simd, LaneSumsOfOnePackAreThoseOfManyPacks) {
  for (int count = 0; count <= 9; ++count) {
    Pack packs[9];
    for (int p = 0; p < 9; ++p) packs[p] = numbers(static_cast<std::uint32_t>(10 + p), -3, 5);
    std::array<double, 10> sums, alone;
    sums.fill(-1);
    lane_sums(packs, count, sums.data());
    for (int p = 0; p < count; ++p) {
      lane_sums(packs + p, 1, alone.data());
      EXPECT_EQ(sums[static_cast<std::size_t>(p)], alone[0]);
    }
    EXPECT_EQ(sums[static_cast<std::size_t>(count)], -1);
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

TEST(Simd, LoadsAndStoresAtAnyAddress) {
  std::array<double, Pack::lanes + 2> from{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, to{};
  Pack::load_unaligned(from.data() + 1).store_unaligned(to.data() + 1);
  for (std::size_t k = 0; k < to.size(); ++k) EXPECT_EQ(to[k], k == 0 || k == 9 ? 0 : from[k]);
}

TEST(Simd, EveryLaneCanBeSetAndRead) {
  Pack a(0, 1, 2, 3, 4, 5, 6, 7);
  for (int k = 0; k < Pack::lanes; ++k) EXPECT_EQ(a[k], k);
  for (int k = 0; k < Pack::lanes; ++k) {
    a.set(k, -10 - k);
    for (int l = 0; l < Pack::lanes; ++l) EXPECT_EQ(a[l], l <= k ? -10 - l : l);
  }
  EXPECT_EQ(largest(a), -10);
}

TEST(Simd, MasksCombine) {
  for (std::uint32_t x : {0x00u, 0x0fu, 0xa5u, 0xffu})
    for (std::uint32_t y : {0x00u, 0x33u, 0x81u, 0xffu}) {
      Pack a = 0.0, b = 0.0;
      for (int k = 0; k < Pack::lanes; ++k) a.set(k, x >> k & 1), b.set(k, y >> k & 1);
      const Mask p = a > Pack(0.5), q = b > Pack(0.5);
      EXPECT_EQ(to_integer(p & q), x & y);
      EXPECT_EQ(to_integer(p | q), x | y);
      EXPECT_EQ(to_integer(!p), ~x & 0xff);
      EXPECT_EQ(any(p), x != 0);
    }
}

TEST(Simd, LanesBetween) {
  for (int begin = -3; begin < 12; ++begin)
    for (int end = -3; end < 12; ++end) {
      std::uint32_t expected = 0;
      for (int k = 0; k < Pack::lanes; ++k) expected |= (k >= begin && k < end ? 1u : 0u) << k;
      EXPECT_EQ(to_integer(lanes_between(begin, end)), expected) << begin << ' ' << end;
    }
}

// Every set of lanes there is; what lies around it must stay as it was.
TEST(Simd, StoresTheLanesOfAMask) {
  const auto a = numbers(8, -1, 1);
  for (std::uint32_t bits = 0; bits < 256; ++bits) {
    Pack chosen = 0.0;
    for (int k = 0; k < Pack::lanes; ++k) chosen.set(k, bits >> k & 1);
    std::array<double, Pack::lanes + 2> memory;
    memory.fill(7);
    store_where(chosen > Pack(0.5), a, memory.data() + 1);
    EXPECT_EQ(memory.front(), 7);
    EXPECT_EQ(memory.back(), 7);
    for (int k = 0; k < Pack::lanes; ++k)
      EXPECT_EQ(memory[static_cast<std::size_t>(k) + 1], bits >> k & 1 ? a[k] : 7) << bits;
  }
}

TEST(Simd, CompressKeepsTheNumbersOfASet) {
  const std::array<std::uint32_t, 8> in{10, 0xffffffff, 12, 13, 0x80000000, 15, 16, 17};
  for (std::uint32_t bits = 0; bits < 256; ++bits) {
    std::array<std::uint32_t, 9> out{};
    out[8] = 99;
    std::array<std::uint32_t, 8> expected{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < 8; ++k)
      if (bits >> k & 1) expected[count++] = in[k];
    EXPECT_EQ(compress(bits, in.data(), out.data()), static_cast<int>(count));
    for (std::size_t k = 0; k < count; ++k) EXPECT_EQ(out[k], expected[k]) << bits;
    EXPECT_EQ(out[8], 99u);
  }
}

TEST(Simd, GathersFromAnywhere) {
  std::array<double, 100> base;
  for (std::size_t k = 0; k < base.size(); ++k) base[k] = static_cast<double>(k * k);
  const std::array<std::uint32_t, 8> index{99, 0, 3, 3, 57, 8, 98, 1};
  const auto a = gather(base.data(), index.data());
  for (int k = 0; k < Pack::lanes; ++k) EXPECT_EQ(a[k], base[index[static_cast<std::size_t>(k)]]);
}

TEST(Simd, PowersOfTwo) {
  for (int n = -1022; n + Pack::lanes <= 1024; n += Pack::lanes) {
    Pack exponent = 0.0;
    for (int k = 0; k < Pack::lanes; ++k) exponent.set(k, n + k);
    const auto power = power_of_two(exponent);
    for (int k = 0; k < Pack::lanes; ++k) EXPECT_EQ(power[k], std::ldexp(1.0, n + k));
  }
}

TEST(Simd, SquareRootOfTheProcessorIsRoundedCorrectly) {
  for (std::uint32_t draw = 0; draw < 50; ++draw) {
    const auto a = numbers(draw, 0, 60), root = ieee_sqrt(a), seventh = power(a, 1.0 / 7);
    for (int k = 0; k < Pack::lanes; ++k) {
      EXPECT_EQ(root[k], std::sqrt(a[k]));
      EXPECT_EQ(seventh[k], std::pow(a[k], 1.0 / 7));
    }
  }
}

TEST(Simd, MulAddIsThatOfDouble) {
  const auto a = numbers(21, -3, 5), b = numbers(22, -3, 5), c = numbers(23, -3, 5), r = mul_add(a, b, c);
  for (int k = 0; k < Pack::lanes; ++k) EXPECT_EQ(r[k], mul_add(a[k], b[k], c[k]));
}

// Row r has the numbers 10 r + column.
TEST(Simd, Transposes) {
  Register rows[8], columns[8], four[4], four_columns[4];
  const auto ten = [](double r) { return simd::eight(r, r + 1, r + 2, r + 3, r + 4, r + 5, r + 6, r + 7); };
  for (int r = 0; r < 8; ++r) rows[r] = ten(10 * r);
  simd::transpose8(rows, columns);
  for (int c = 0; c < 8; ++c)
    for (int r = 0; r < 8; ++r) EXPECT_EQ(simd::lane(columns[c], r), 10 * r + c);

  for (int r = 0; r < 4; ++r) four[r] = simd::halves(simd::low_half(rows[r]), simd::low_half(rows[r + 4]));
  simd::transpose4(four, four_columns);
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 8; ++r) EXPECT_EQ(simd::lane(four_columns[c], r), 10 * r + c);

  simd::transpose4_any_order(four, four_columns);
  for (int r = 0; r < 8; ++r) {
    const double first = simd::lane(four_columns[0], r);
    for (int c = 1; c < 4; ++c) EXPECT_EQ(simd::lane(four_columns[c], r), first + c);
    for (int q = 0; q < r; ++q) EXPECT_NE(simd::lane(four_columns[0], q), first);
  }
}

TEST(Simd, ShufflesAndHalves) {
  const Register a = simd::eight(0, 1, 2, 3, 4, 5, 6, 7), b = simd::eight(8, 9, 10, 11, 12, 13, 14, 15);
  const auto same = [](Register r, std::array<double, 8> expected) {
    for (int k = 0; k < 8; ++k) EXPECT_EQ(simd::lane(r, k), expected[static_cast<std::size_t>(k)]);
  };
  same(simd::shuffle<0, 1, 2, 8, 4, 5, 6, 8>(a, b), {0, 1, 2, 8, 4, 5, 6, 8});
  same(simd::shuffle<0, 0, 0, 1, 1, 2, 8, 9>(a, b), {0, 0, 0, 1, 1, 2, 8, 9});
  same(simd::shuffle<7, 5, 12, 4, 15, 14, 13, 12>(a, b), {7, 5, 12, 4, 15, 14, 13, 12});
  same(simd::halves(simd::high_half(a), simd::low_half(b)), {4, 5, 6, 7, 8, 9, 10, 11});
  same(simd::subtract_then_add(a, b), {-8, -8, -8, -8, 16, 18, 20, 22});
}

TEST(Simd, FoursHoldHalfARow) {
  alignas(32) std::array<double, 4> memory{1, -2, 3, 4};
  const simd::Four a = simd::load_four(memory.data()), last = simd::spread<3>(a), b = simd::four(5, 6, 7, 8);
  const simd::Four kept = simd::three_and_one(b, a), size = simd::most(simd::magnitude(a), simd::four(2.5));
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(simd::lane(last, k), 4);
    EXPECT_EQ(simd::lane(kept, k), k < 3 ? 5 + k : 4);
    EXPECT_EQ(simd::lane(size, k), std::max(std::fabs(memory[static_cast<std::size_t>(k)]), 2.5));
  }
}

}  // namespace
}  // namespace bagnold

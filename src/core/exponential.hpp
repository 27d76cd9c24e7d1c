// exp and its relatives for any number type: one formula, so that a number and a lane of a pack get the same bits.
#pragma once
#include <bit>
#include <cstdint>

#include "core/numeric.hpp"

namespace bagnold {

// Adding it leaves the integer nearest to a number below 2^51 in the low bits of the sum.
inline constexpr double integer_bits = 6755399441055744.0;  // 1.5 * 2^52

inline double nearest_integer(double a) { return (a + integer_bits) - integer_bits; }
// 2^n for an integer n of -1022 to 1023.
inline double power_of_two(double n) {
  return std::bit_cast<double>((std::bit_cast<std::uint64_t>(n + integer_bits) + 1023) << 52);
}

// exp(x) for -700 <= x <= 0, relative error below 4e-16: x = n ln 2 + r, |r| <= ln 2 / 2, Taylor series of exp(r).
template <class T>
inline T exp_negative(T x) {
  constexpr double ln2_hi = 6.93147180369123816490e-01, ln2_lo = 1.90821492927058770002e-10;
  x = max(x, T(-700));
  const T n = nearest_integer(T(x * 1.44269504088896340736)), r = (x - n * ln2_hi) - n * ln2_lo;
  T series = T(1.0 / 6227020800.0);
  for (const double c : {1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320, 1.0 / 5040,
                         1.0 / 720, 1.0 / 120, 1.0 / 24, 1.0 / 6, 0.5, 1.0, 1.0})
    series = series * r + c;
  return series * power_of_two(n);
}

// (1 - exp(-x)) / x for x >= 0, 1 at x = 0, with exp(-x) at hand.
template <class T>
inline T one_minus_exp_over(T x, T exp_minus_x) {
  const T small = 1 - x * (0.5 - x * (1.0 / 6 - x * (1.0 / 24 - x * (1.0 / 120 - x * (1.0 / 720)))));
  const T large = (1 - exp_minus_x) * reciprocal(max(x, T(1e-3)));
  return select(x < T(1e-2), small, large);
}
template <class T>
inline T one_minus_exp_over(T x) {
  return one_minus_exp_over(x, exp_negative(T(-x)));
}

}  // namespace bagnold

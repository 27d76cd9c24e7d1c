// Eight doubles that move together as one plain vector value: what the continuum loops load, transpose and sum. The width
// is one AVX-512 register; the compiler splits it where there is less. Laws are templates over their number type.
#pragma once
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "core/numeric.hpp"
#if defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace bagnold {

using Octet = double __attribute__((vector_size(64)));
using OctetMask = std::int64_t __attribute__((vector_size(64)));
inline constexpr int octet_size = 8;

inline Octet splat(double a) { return Octet{a, a, a, a, a, a, a, a}; }
inline Octet load_octet(const double* from) {
  Octet p;
  std::memcpy(&p, from, sizeof p);
  return p;
}
inline void store_octet(double* to, const Octet& p) { std::memcpy(to, &p, sizeof p); }

// Sum of the lanes, always in the same order.
inline double lane_sum(const Octet& p) { return ((p[0] + p[4]) + (p[1] + p[5])) + ((p[2] + p[6]) + (p[3] + p[7])); }
inline double lane_max(const Octet& p) {
  double m = p[0];
  for (int k = 1; k < octet_size; ++k) m = p[k] > m ? p[k] : m;
  return m;
}

inline Octet sqrt(const Octet& a) {
#if defined(__AVX512F__)
  return reinterpret_cast<Octet>(_mm512_maskz_sqrt_pd(0xff, reinterpret_cast<__m512d>(a)));
#else
  Octet r;
  for (int k = 0; k < octet_size; ++k) r[k] = std::sqrt(a[k]);
  return r;
#endif
}

// The larger and the smaller of two numbers, for double and Octet alike.
template <class T>
inline T larger(const T& a, const T& b) {
  return a > b ? a : b;
}
template <class T>
inline T smaller(const T& a, const T& b) {
  return a < b ? a : b;
}

// The constant `a` as a T.
template <class T>
inline T constant(double a) {
  if constexpr (sizeof(T) == sizeof(double))
    return a;
  else
    return splat(a);
}

// exp(x) for -700 <= x <= 0, relative error below 4e-16: x = n ln 2 + r, |r| <= ln 2 / 2, Taylor series of exp(r).
// One formula for double and Octet, so both give the same bits.
template <class T>
inline T exp_negative(T x) {
  constexpr double ln2_hi = 6.93147180369123816490e-01, ln2_lo = 1.90821492927058770002e-10;
  constexpr double round_to_integer = 6755399441055744.0;  // 1.5 * 2^52: adding it leaves the integer in the low bits
  x = larger(x, constant<T>(-700));
  const T shifted = x * 1.44269504088896340736 + round_to_integer;
  const T n = shifted - round_to_integer;
  const T r = (x - n * ln2_hi) - n * ln2_lo;
  T series = constant<T>(1.0 / 6227020800.0);
  for (const double c : {1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320, 1.0 / 5040,
                         1.0 / 720, 1.0 / 120, 1.0 / 24, 1.0 / 6, 0.5, 1.0, 1.0})
    series = series * r + c;
  using Bits = std::conditional_t<sizeof(T) == sizeof(double), std::int64_t, OctetMask>;
  Bits bits, power;
  std::memcpy(&bits, &shifted, sizeof bits);
  std::memcpy(&power, &series, sizeof power);
  power += bits << 52;  // multiplies by 2^n
  std::memcpy(&series, &power, sizeof series);
  return series;
}

// (1 - exp(-x)) / x for x >= 0, 1 at x = 0.
template <class T>
inline T one_minus_exp_over(T x) {
  const T small = 1 - x * (0.5 - x * (1.0 / 6 - x * (1.0 / 24 - x * (1.0 / 120 - x * (1.0 / 720)))));
  const T large = (1 - exp_negative(T(-x))) / larger(x, constant<T>(1e-3));
  return x < 1e-2 ? small : large;
}

// Transposes eight packs: out[f][k] = in[k][f].
inline void transpose(Octet (&r)[octet_size]) {
  Octet a[8], b[8];
  for (int k = 0; k < 4; ++k) {
    a[2 * k] = __builtin_shufflevector(r[2 * k], r[2 * k + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    a[2 * k + 1] = __builtin_shufflevector(r[2 * k], r[2 * k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int k = 0; k < 2; ++k)
    for (int s = 0; s < 2; ++s) {
      b[4 * k + s] = __builtin_shufflevector(a[4 * k + s], a[4 * k + 2 + s], 0, 1, 8, 9, 4, 5, 12, 13);
      b[4 * k + 2 + s] = __builtin_shufflevector(a[4 * k + s], a[4 * k + 2 + s], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  for (int s = 0; s < 4; ++s) {
    r[s] = __builtin_shufflevector(b[s], b[4 + s], 0, 1, 2, 3, 8, 9, 10, 11);
    r[4 + s] = __builtin_shufflevector(b[s], b[4 + s], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

}  // namespace bagnold

// A pack of numbers that behaves like one: the laws, written for any number type, run on it unchanged. Arithmetic is
// the compiler's own vector type, which every x86-64 can execute; square roots, masks and gathers use AVX-512 or AVX2
// where the build has them.
#pragma once
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/exponential.hpp"
#if defined(__AVX2__)
#include <immintrin.h>
#endif

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // vectors are never passed between objects built differently

namespace bagnold {

// The name of the variant is part of every symbol, so that builds of two variants can be linked together.
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__) && !defined(BAGNOLD_SIMD_PLAIN)
#define BAGNOLD_AVX512 1
inline namespace avx512 {
#elif defined(__AVX2__) && !defined(BAGNOLD_SIMD_PLAIN)
inline namespace avx2 {
#else
inline namespace plain {
#endif

inline constexpr int register_lanes = 8;
using Register = double __attribute__((vector_size(64), may_alias));

namespace detail {

#ifdef BAGNOLD_AVX512
using Bits = __mmask8;
inline Bits less(Register a, Register b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
inline Register blend(Bits m, Register a, Register b) { return _mm512_mask_mov_pd(b, m, a); }
inline Register least(Register a, Register b) { return _mm512_maskz_min_pd(0xff, a, b); }
inline Register most(Register a, Register b) { return _mm512_maskz_max_pd(0xff, a, b); }
inline Register magnitude(Register a) { return _mm512_abs_pd(a); }
inline std::uint32_t to_integer(Bits m) { return m; }
// 1/sqrt(1 - e) = 1 + e/2 + 3 e^2/8 + 5 e^3/16 + O(e^4), with e = 1 - a y^2 < 2^-13 for the 14-bit estimate y.
inline Register inverse_root(Register a) {
  // (The zero-masking forms, with every lane kept, are the plain instructions without a false warning.)
  const Register y = _mm512_maskz_rsqrt14_pd(0xff, a), e = 1.0 - (a * y) * y;
  const Register series = (0.3125 * e + 0.375) * e + 0.5;
  return series * (e * y) + y;
}
// 1/(1 - e) = (1 + e) (1 + e^2) + O(e^4), with e = 1 - a y < 2^-13 for the 14-bit estimate y.
inline Register reciprocal(Register a) {
  const Register y = _mm512_maskz_rcp14_pd(0xff, a), e = 1.0 - a * y, z = y * e + y;
  return z * (e * e) + z;
}
// One Newton step on a y removes the last rounding error; tiny keeps 0 * infinity out.
inline Register root(Register a) {
  const Register b = most(a, Register{} + 1e-300), y = inverse_root(b), s = b * y;
  return blend(less(Register{}, a), s + (0.5 * y) * (b - s * s), Register{});
}
#else
using Bits = std::int64_t __attribute__((vector_size(64)));
inline Bits less(Register a, Register b) { return a < b; }
inline Register blend(Bits m, Register a, Register b) { return m ? a : b; }
inline Register least(Register a, Register b) { return a < b ? a : b; }
inline Register most(Register a, Register b) { return a > b ? a : b; }
inline Register magnitude(Register a) { return a < 0.0 ? -a : a; }
inline std::uint32_t to_integer(Bits m) {
  std::uint32_t bits = 0;
  for (int k = 0; k < register_lanes; ++k) bits |= (m[k] != 0 ? 1u : 0u) << k;
  return bits;
}
inline Register root(Register a) {
#if defined(__AVX2__) && !defined(BAGNOLD_SIMD_PLAIN)
  __m256d half[2];
  std::memcpy(half, &a, sizeof a);
  for (__m256d& h : half) h = _mm256_sqrt_pd(h);
  std::memcpy(&a, half, sizeof a);
#else
  for (int k = 0; k < register_lanes; ++k) a[k] = std::sqrt(a[k]);
#endif
  return a;
}
inline Register inverse_root(Register a) { return 1.0 / root(a); }
inline Register reciprocal(Register a) { return 1.0 / a; }
#endif

}  // namespace detail

struct Mask {
  detail::Bits m;
  friend Mask operator&(const Mask& a, const Mask& b) { return {static_cast<detail::Bits>(a.m & b.m)}; }
  friend Mask operator|(const Mask& a, const Mask& b) { return {static_cast<detail::Bits>(a.m | b.m)}; }
  friend Mask operator!(const Mask& a) { return {static_cast<detail::Bits>(~a.m)}; }
};

// Eight numbers.
struct Pack {
  static constexpr int lanes = register_lanes;
  Register v;

  Pack() = default;
  Pack(double a) : v{a, a, a, a, a, a, a, a} {}
  explicit Pack(Register r) : v(r) {}
  static Pack load(const double* p) { return Pack(*reinterpret_cast<const Register*>(p)); }  // aligned to 64 bytes
  static Pack load_unaligned(const double* p) {
    Pack a;
    std::memcpy(&a.v, p, sizeof a.v);
    return a;
  }
  void store(double* p) const { *reinterpret_cast<Register*>(p) = v; }
  void store_unaligned(double* p) const { std::memcpy(p, &v, sizeof v); }
  double operator[](int lane) const { return v[lane]; }
  void set(int lane, double a) { v[lane] = a; }

  friend Pack operator+(const Pack& a, const Pack& b) { return Pack(a.v + b.v); }
  friend Pack operator-(const Pack& a, const Pack& b) { return Pack(a.v - b.v); }
  friend Pack operator*(const Pack& a, const Pack& b) { return Pack(a.v * b.v); }
  friend Pack operator/(const Pack& a, const Pack& b) { return Pack(a.v / b.v); }
  friend Pack operator-(const Pack& a) { return Pack(-a.v); }
  Pack& operator+=(const Pack& a) { return v += a.v, *this; }
  Pack& operator-=(const Pack& a) { return v -= a.v, *this; }
  Pack& operator*=(const Pack& a) { return v *= a.v, *this; }
  friend Pack min(const Pack& a, const Pack& b) { return Pack(detail::least(a.v, b.v)); }
  friend Pack max(const Pack& a, const Pack& b) { return Pack(detail::most(a.v, b.v)); }
  friend Pack abs(const Pack& a) { return Pack(detail::magnitude(a.v)); }
  friend Pack sqrt(const Pack& a) { return Pack(detail::root(a.v)); }
  friend Pack rsqrt(const Pack& a) { return Pack(detail::inverse_root(a.v)); }
  // The processor's own, correctly rounded square root: keeps the multipliers free, where sqrt() keeps the divider free.
  friend Pack ieee_sqrt(const Pack& a) {
#ifdef BAGNOLD_AVX512
    return Pack(static_cast<Register>(_mm512_maskz_sqrt_pd(0xff, a.v)));
#else
    return sqrt(a);
#endif
  }
  friend Pack power(Pack a, double exponent) {
    for (int k = 0; k < lanes; ++k) a.v[k] = std::pow(a.v[k], exponent);
    return a;
  }
  friend Pack reciprocal(const Pack& a) { return Pack(detail::reciprocal(a.v)); }
  friend Mask operator<(const Pack& a, const Pack& b) { return {detail::less(a.v, b.v)}; }
  friend Mask operator>(const Pack& a, const Pack& b) { return b < a; }
  // a b + c, fused where the build has the instruction: for functions of one number, not for sums that must be symmetric.
  friend Pack mul_add(const Pack& a, const Pack& b, const Pack& c) {
#ifdef BAGNOLD_AVX512
    return Pack(static_cast<Register>(_mm512_fmadd_pd(a.v, b.v, c.v)));
#elif defined(__FMA__)
    Pack r;
    for (int k = 0; k < lanes; ++k) r.v[k] = __builtin_fma(a.v[k], b.v[k], c.v[k]);
    return r;
#else
    return a * b + c;
#endif
  }
  friend Pack select(const Mask& m, const Pack& a, const Pack& b) { return Pack(detail::blend(m.m, a.v, b.v)); }
};

// Bit k is lane k.
inline std::uint32_t to_integer(const Mask& m) { return detail::to_integer(m.m); }
inline bool any(const Mask& m) { return to_integer(m) != 0; }
constexpr bool worthwhile(const Mask&) { return true; }
// Lanes begin .. end - 1; both may lie outside the pack.
inline Mask lanes_between(int begin, int end) {
  const Pack index(Register{0, 1, 2, 3, 4, 5, 6, 7});
  return (index > Pack(begin - 0.5)) & (index < Pack(end - 0.5));
}
// Writes the lanes of the mask, at any address; the others stay as they are.
inline void store_where(const Mask& mask, const Pack& a, double* p) {
#ifdef BAGNOLD_AVX512
  _mm512_mask_storeu_pd(p, mask.m, a.v);
#else
  const std::uint32_t bits = to_integer(mask);
  if (bits == 0xff) return a.store_unaligned(p);
  for (int k = 0; k < Pack::lanes; ++k)
    if (bits >> k & 1) p[k] = a[k];
#endif
}
inline double largest(const Pack& a) {
  double m = a[0];
  for (int k = 1; k < Pack::lanes; ++k) m = a[k] > m ? a[k] : m;
  return m;
}

// Writes the numbers whose bit is set to the front of `out`, which has room for eight; returns how many.
inline int compress(std::uint32_t bits, const std::uint32_t* in, std::uint32_t* out) {
#ifdef BAGNOLD_AVX512
  const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(in));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm256_maskz_compress_epi32(static_cast<__mmask8>(bits), all));
#else
  for (int k = 0, n = 0; k < register_lanes; ++k)
    if (bits >> k & 1) out[n++] = in[k];
#endif
  return __builtin_popcount(bits);
}

// Sum of the lanes, always in the same order.
inline double lane_sum(const Pack& a) { return ((a[0] + a[4]) + (a[1] + a[5])) + ((a[2] + a[6]) + (a[3] + a[7])); }

namespace detail {

// Halves of the 2 x 2 and of the 4 x 4 transpositions: numbers 0, 2, 4, 6 of a and b in turn, numbers 1, 3, 5, 7; pairs 0
// and 2 of both in turn, pairs 1 and 3; and the same pairs, those of a first, which is cheaper.
inline Register evens(Register a, Register b) { return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14); }
inline Register odds(Register a, Register b) { return __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15); }
inline Register even_pairs(Register a, Register b) { return __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13); }
inline Register odd_pairs(Register a, Register b) { return __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15); }
inline Register even_pairs_of_each(Register a, Register b) {
  return __builtin_shufflevector(a, b, 0, 1, 4, 5, 8, 9, 12, 13);
}
inline Register odd_pairs_of_each(Register a, Register b) {
  return __builtin_shufflevector(a, b, 2, 3, 6, 7, 10, 11, 14, 15);
}

}  // namespace detail

// The lane sums of `count` packs, four at a time, always in the same order.
inline void lane_sums(const Pack* a, int count, double* sums) {
  using Half = double __attribute__((vector_size(32)));
  const auto four_sums = [](Register a0, Register a1, Register a2, Register a3) {
    const Register two = detail::evens(a0, a1) + detail::odds(a0, a1),
                   more = detail::evens(a2, a3) + detail::odds(a2, a3),
                   four = detail::even_pairs(two, more) + detail::odd_pairs(two, more);
    return Half(__builtin_shufflevector(four, four, 0, 1, 2, 3) + __builtin_shufflevector(four, four, 4, 5, 6, 7));
  };
  int k = 0;
  for (; k + 4 <= count; k += 4) {
    const Half half = four_sums(a[k].v, a[k + 1].v, a[k + 2].v, a[k + 3].v);
    std::memcpy(sums + k, &half, sizeof half);
  }
  if (k == count) return;
  const auto at = [&](int i) { return i < count ? a[i].v : Register{}; };
  const Half rest = four_sums(at(k), at(k + 1), at(k + 2), at(k + 3));
  for (int i = 0; k < count; ++i, ++k) sums[k] = rest[i];
}
template <int N>
inline void lane_sums(const Pack (&a)[N], double* sums) {
  lane_sums(a, N, sums);
}

// base[index[k]] in lane k.
inline Pack gather(const double* base, const std::uint32_t* index) {
  Pack p;
#ifdef BAGNOLD_AVX512
  p.v =
      _mm512_mask_i32gather_pd(Register{}, 0xff, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(index)), base, 8);
#else
  for (int k = 0; k < register_lanes; ++k) p.set(k, base[index[k]]);
#endif
  return p;
}

// As for double: the integer nearest to a, for |a| < 2^51, and 2^n for an integer n of -1022 to 1023.
inline Pack nearest_integer(const Pack& a) { return (a + integer_bits) - integer_bits; }
inline Pack power_of_two(const Pack& n) {
  using Integers = std::uint64_t __attribute__((vector_size(64), may_alias));
  return Pack(reinterpret_cast<Register>((reinterpret_cast<Integers>((n + integer_bits).v) + 1023) << 52));
}

}  // inline namespace
}  // namespace bagnold

#pragma GCC diagnostic pop

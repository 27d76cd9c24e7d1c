// Packs are four registers of SSE2, which every x86-64 has.
#pragma once
#include <emmintrin.h>

#include <cstdint>

namespace bagnold::inline BAGNOLD_SIMD_VARIANT::simd {

struct Four {
  __m128d lo, hi;
};
using FourBits = Four;  // all bits of a lane

BAGNOLD_SIMD_INLINE Four operator+(Four a, Four b) { return {a.lo + b.lo, a.hi + b.hi}; }
BAGNOLD_SIMD_INLINE Four operator-(Four a, Four b) { return {a.lo - b.lo, a.hi - b.hi}; }
BAGNOLD_SIMD_INLINE Four operator*(Four a, Four b) { return {a.lo * b.lo, a.hi * b.hi}; }
BAGNOLD_SIMD_INLINE Four operator/(Four a, Four b) { return {a.lo / b.lo, a.hi / b.hi}; }
BAGNOLD_SIMD_INLINE Four operator-(Four a) { return {-a.lo, -a.hi}; }

BAGNOLD_SIMD_INLINE Four four(double a) { return {_mm_set1_pd(a), _mm_set1_pd(a)}; }
BAGNOLD_SIMD_INLINE Four four(double a, double b, double c, double d) { return {_mm_setr_pd(a, b), _mm_setr_pd(c, d)}; }
BAGNOLD_SIMD_INLINE Four load_four(const double* p) { return {_mm_load_pd(p), _mm_load_pd(p + 2)}; }
BAGNOLD_SIMD_INLINE Four load_four_unaligned(const double* p) { return {_mm_loadu_pd(p), _mm_loadu_pd(p + 2)}; }
BAGNOLD_SIMD_INLINE void store(double* p, Four a) {
  _mm_store_pd(p, a.lo);
  _mm_store_pd(p + 2, a.hi);
}
BAGNOLD_SIMD_INLINE void store_unaligned(double* p, Four a) {
  _mm_storeu_pd(p, a.lo);
  _mm_storeu_pd(p + 2, a.hi);
}
BAGNOLD_SIMD_INLINE double lane(Four a, int k) { return k < 2 ? a.lo[k] : a.hi[k - 2]; }

BAGNOLD_SIMD_INLINE Four fused(Four a, Four b, Four c) { return a * b + c; }  // there is no such instruction
BAGNOLD_SIMD_INLINE FourBits less(Four a, Four b) { return {_mm_cmplt_pd(a.lo, b.lo), _mm_cmplt_pd(a.hi, b.hi)}; }
BAGNOLD_SIMD_INLINE FourBits both(FourBits a, FourBits b) { return {_mm_and_pd(a.lo, b.lo), _mm_and_pd(a.hi, b.hi)}; }
BAGNOLD_SIMD_INLINE FourBits either(FourBits a, FourBits b) { return {_mm_or_pd(a.lo, b.lo), _mm_or_pd(a.hi, b.hi)}; }
BAGNOLD_SIMD_INLINE Four and_not(FourBits a, Four b) { return {_mm_andnot_pd(a.lo, b.lo), _mm_andnot_pd(a.hi, b.hi)}; }
BAGNOLD_SIMD_INLINE FourBits opposite(FourBits a) {
  const __m128d ones = _mm_castsi128_pd(_mm_set1_epi32(-1));
  return and_not(a, {ones, ones});
}
BAGNOLD_SIMD_INLINE Four blend(FourBits m, Four a, Four b) { return either(both(m, a), and_not(m, b)); }
BAGNOLD_SIMD_INLINE std::uint32_t to_integer(FourBits m) {
  return static_cast<std::uint32_t>(_mm_movemask_pd(m.lo) | _mm_movemask_pd(m.hi) << 2);
}
BAGNOLD_SIMD_INLINE Four least(Four a, Four b) { return {_mm_min_pd(a.lo, b.lo), _mm_min_pd(a.hi, b.hi)}; }
BAGNOLD_SIMD_INLINE Four most(Four a, Four b) { return {_mm_max_pd(a.lo, b.lo), _mm_max_pd(a.hi, b.hi)}; }
BAGNOLD_SIMD_INLINE Four magnitude(Four a) { return and_not(four(-0.0), a); }
BAGNOLD_SIMD_INLINE Four root(Four a) { return {_mm_sqrt_pd(a.lo), _mm_sqrt_pd(a.hi)}; }
BAGNOLD_SIMD_INLINE Four inverse_root(Four a) { return four(1) / root(a); }
BAGNOLD_SIMD_INLINE Four reciprocal(Four a) { return four(1) / a; }
BAGNOLD_SIMD_INLINE Four power_from_bits(Four a) {
  const auto power = [](__m128d x) {
    return _mm_castsi128_pd(_mm_slli_epi64(_mm_add_epi64(_mm_castpd_si128(x), _mm_set1_epi64x(1023)), 52));
  };
  return {power(a.lo), power(a.hi)};
}
BAGNOLD_SIMD_INLINE void store_where(double* p, FourBits m, Four a) {
  for (int k = 0; k < 4; ++k)
    if (to_integer(m) >> k & 1) p[k] = lane(a, k);
}

// Lanes of a and b, counted through.
template <int k0, int k1, int k2, int k3>
BAGNOLD_SIMD_INLINE Four shuffle(Four a, Four b) {
  const __m128d part[4] = {a.lo, a.hi, b.lo, b.hi};
  return {_mm_shuffle_pd(part[k0 / 2], part[k1 / 2], k0 % 2 | k1 % 2 << 1),
          _mm_shuffle_pd(part[k2 / 2], part[k3 / 2], k2 % 2 | k3 % 2 << 1)};
}
// Lane k in all lanes.
template <int k>
BAGNOLD_SIMD_INLINE Four spread(Four a) {
  return shuffle<k, k, k, k>(a, a);
}
// Lanes 0, 1 and 2 of a, lane 3 of b.
BAGNOLD_SIMD_INLINE Four three_and_one(Four a, Four b) { return shuffle<0, 1, 2, 7>(a, b); }
BAGNOLD_SIMD_INLINE void transpose4x4(Four (&a)[4]) {
  const auto even = [](__m128d x, __m128d y) { return _mm_unpacklo_pd(x, y); };
  const auto odd = [](__m128d x, __m128d y) { return _mm_unpackhi_pd(x, y); };
  const Four r[4] = {a[0], a[1], a[2], a[3]};
  a[0] = {even(r[0].lo, r[1].lo), even(r[2].lo, r[3].lo)};
  a[1] = {odd(r[0].lo, r[1].lo), odd(r[2].lo, r[3].lo)};
  a[2] = {even(r[0].hi, r[1].hi), even(r[2].hi, r[3].hi)};
  a[3] = {odd(r[0].hi, r[1].hi), odd(r[2].hi, r[3].hi)};
}
BAGNOLD_SIMD_INLINE Four lane_sums(Four a, Four b, Four c, Four d) {
  const auto sums = [](Four x, Four y) {
    const __m128d u = x.lo + x.hi, v = y.lo + y.hi;
    return _mm_unpacklo_pd(u, v) + _mm_unpackhi_pd(u, v);
  };
  return {sums(a, b), sums(c, d)};
}

BAGNOLD_SIMD_INLINE void compress(std::uint32_t bits, const std::uint32_t* in, std::uint32_t* out) {
  for (unsigned k = 0, n = 0; k < 8; ++k) {  // no branch: what is not wanted is written over
    out[n] = in[k];
    n += bits >> k & 1;
  }
}

}  // namespace bagnold::inline BAGNOLD_SIMD_VARIANT::simd

#include "core/simd/two_fours.hpp"

// Four numbers in one 256-bit register: half a pack of AVX-512 and of AVX2, and half a row of a grain.
#pragma once
#include <immintrin.h>

#include <cstdint>

namespace bagnold::inline BAGNOLD_SIMD_VARIANT::simd {

using Four = __m256d;  // the compiler's vector type: + - * / are its own

BAGNOLD_SIMD_INLINE Four four(double a) { return _mm256_set1_pd(a); }
BAGNOLD_SIMD_INLINE Four four(double a, double b, double c, double d) { return _mm256_setr_pd(a, b, c, d); }
BAGNOLD_SIMD_INLINE Four load_four(const double* p) { return _mm256_load_pd(p); }
BAGNOLD_SIMD_INLINE Four load_four_unaligned(const double* p) { return _mm256_loadu_pd(p); }
BAGNOLD_SIMD_INLINE void store(double* p, Four a) { _mm256_store_pd(p, a); }
BAGNOLD_SIMD_INLINE void store_unaligned(double* p, Four a) { _mm256_storeu_pd(p, a); }
BAGNOLD_SIMD_INLINE double lane(Four a, int k) { return a[k]; }

BAGNOLD_SIMD_INLINE Four most(Four a, Four b) { return _mm256_max_pd(a, b); }
BAGNOLD_SIMD_INLINE Four magnitude(Four a) { return _mm256_andnot_pd(four(-0.0), a); }
// Lane k in all lanes.
template <int k>
BAGNOLD_SIMD_INLINE Four spread(Four a) {
  return _mm256_permute4x64_pd(a, k * 0x55);
}
// Lanes 0, 1 and 2 of a, lane 3 of b.
BAGNOLD_SIMD_INLINE Four three_and_one(Four a, Four b) { return _mm256_blend_pd(a, b, 8); }

}  // namespace bagnold::inline BAGNOLD_SIMD_VARIANT::simd

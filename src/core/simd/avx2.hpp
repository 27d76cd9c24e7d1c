// Packs are two registers of AVX2 with FMA (x86-64-v3).
#pragma once
#include "core/simd/four_avx.hpp"

namespace bagnold::inline BAGNOLD_SIMD_VARIANT::simd {

using FourBits = __m256d;  // all bits of a lane

BAGNOLD_SIMD_INLINE Four fused(Four a, Four b, Four c) { return _mm256_fmadd_pd(a, b, c); }
BAGNOLD_SIMD_INLINE FourBits less(Four a, Four b) { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
BAGNOLD_SIMD_INLINE Four blend(FourBits m, Four a, Four b) { return _mm256_blendv_pd(b, a, m); }
BAGNOLD_SIMD_INLINE FourBits both(FourBits a, FourBits b) { return _mm256_and_pd(a, b); }
BAGNOLD_SIMD_INLINE FourBits either(FourBits a, FourBits b) { return _mm256_or_pd(a, b); }
BAGNOLD_SIMD_INLINE FourBits opposite(FourBits a) {
  return _mm256_xor_pd(a, _mm256_castsi256_pd(_mm256_set1_epi64x(-1)));
}
BAGNOLD_SIMD_INLINE std::uint32_t to_integer(FourBits m) { return static_cast<std::uint32_t>(_mm256_movemask_pd(m)); }
BAGNOLD_SIMD_INLINE Four least(Four a, Four b) { return _mm256_min_pd(a, b); }
BAGNOLD_SIMD_INLINE Four root(Four a) { return _mm256_sqrt_pd(a); }
BAGNOLD_SIMD_INLINE Four inverse_root(Four a) { return four(1) / root(a); }
BAGNOLD_SIMD_INLINE Four reciprocal(Four a) { return four(1) / a; }
BAGNOLD_SIMD_INLINE Four power_from_bits(Four a) {
  const __m256i biased = _mm256_add_epi64(_mm256_castpd_si256(a), _mm256_set1_epi64x(1023));
  return _mm256_castsi256_pd(_mm256_slli_epi64(biased, 52));
}
BAGNOLD_SIMD_INLINE void store_where(double* p, FourBits m, Four a) {
  _mm256_maskstore_pd(p, _mm256_castpd_si256(m), a);
}
BAGNOLD_SIMD_INLINE void transpose4x4(Four (&a)[4]) {
  const Four even01 = _mm256_unpacklo_pd(a[0], a[1]), odd01 = _mm256_unpackhi_pd(a[0], a[1]),
             even23 = _mm256_unpacklo_pd(a[2], a[3]), odd23 = _mm256_unpackhi_pd(a[2], a[3]);
  a[0] = _mm256_permute2f128_pd(even01, even23, 0x20);
  a[1] = _mm256_permute2f128_pd(odd01, odd23, 0x20);
  a[2] = _mm256_permute2f128_pd(even01, even23, 0x31);
  a[3] = _mm256_permute2f128_pd(odd01, odd23, 0x31);
}
BAGNOLD_SIMD_INLINE Four lane_sums(Four a, Four b, Four c, Four d) {
  const Four ab = _mm256_unpacklo_pd(a, b) + _mm256_unpackhi_pd(a, b),
             cd = _mm256_unpacklo_pd(c, d) + _mm256_unpackhi_pd(c, d);
  return _mm256_permute2f128_pd(ab, cd, 0x20) + _mm256_permute2f128_pd(ab, cd, 0x31);
}

// Which lanes come to the front for every set of bits: one byte each.
struct CompressTable {
  std::uint64_t order[256];
  constexpr CompressTable() : order{} {
    for (unsigned bits = 0; bits < 256; ++bits)
      for (unsigned k = 0, n = 0; k < 8; ++k)
        if (bits >> k & 1) order[bits] |= std::uint64_t{k} << 8 * n++;
  }
};
inline constexpr CompressTable compress_table;

BAGNOLD_SIMD_INLINE void compress(std::uint32_t bits, const std::uint32_t* in, std::uint32_t* out) {
  const __m128i bytes = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(&compress_table.order[bits]));
  const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(in));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm256_permutevar8x32_epi32(all, _mm256_cvtepu8_epi32(bytes)));
}

// Lanes of a and b, counted through; `from` may name any of them.
template <int k0, int k1, int k2, int k3>
BAGNOLD_SIMD_INLINE Four shuffle(Four a, Four b) {
  return __builtin_shufflevector(a, b, k0, k1, k2, k3);
}

}  // namespace bagnold::inline BAGNOLD_SIMD_VARIANT::simd

#include "core/simd/two_fours.hpp"

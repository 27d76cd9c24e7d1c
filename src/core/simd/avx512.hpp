// Packs are one register of AVX-512 (with DQ and VL: x86-64-v4).
#pragma once
#include "core/simd/four_avx.hpp"

namespace bagnold::inline BAGNOLD_SIMD_VARIANT::simd {

using Register = __m512d;  // the compiler's vector type: + - * / are its own
using Bits = __mmask8;

// The zero-masking forms, with every lane kept, are the plain instructions without a false warning.
constexpr Bits every_lane = 0xff;

BAGNOLD_SIMD_INLINE Register eight(double a) { return _mm512_set1_pd(a); }
BAGNOLD_SIMD_INLINE Register eight(double a, double b, double c, double d, double e, double f, double g, double h) {
  return _mm512_setr_pd(a, b, c, d, e, f, g, h);
}
BAGNOLD_SIMD_INLINE Register halves(Four low, Four high) {
  return _mm512_maskz_insertf64x4(every_lane, _mm512_castpd256_pd512(low), high, 1);
}
BAGNOLD_SIMD_INLINE Four low_half(Register a) { return __builtin_shufflevector(a, a, 0, 1, 2, 3); }
BAGNOLD_SIMD_INLINE Four high_half(Register a) { return __builtin_shufflevector(a, a, 4, 5, 6, 7); }
BAGNOLD_SIMD_INLINE Register load_eight(const double* p) { return _mm512_load_pd(p); }
BAGNOLD_SIMD_INLINE Register load_eight_unaligned(const double* p) { return _mm512_loadu_pd(p); }
BAGNOLD_SIMD_INLINE void store(double* p, Register a) { _mm512_store_pd(p, a); }
BAGNOLD_SIMD_INLINE void store_unaligned(double* p, Register a) { _mm512_storeu_pd(p, a); }
BAGNOLD_SIMD_INLINE void store_where(double* p, Bits m, Register a) { _mm512_mask_storeu_pd(p, m, a); }
BAGNOLD_SIMD_INLINE double lane(Register a, int k) { return a[k]; }
BAGNOLD_SIMD_INLINE void set_lane(Register& a, int k, double value) { a[k] = value; }

BAGNOLD_SIMD_INLINE Register fused(Register a, Register b, Register c) { return _mm512_fmadd_pd(a, b, c); }
BAGNOLD_SIMD_INLINE Bits less(Register a, Register b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
BAGNOLD_SIMD_INLINE Register blend(Bits m, Register a, Register b) { return _mm512_mask_mov_pd(b, m, a); }
BAGNOLD_SIMD_INLINE Bits both(Bits a, Bits b) { return static_cast<Bits>(a & b); }
BAGNOLD_SIMD_INLINE Bits either(Bits a, Bits b) { return static_cast<Bits>(a | b); }
BAGNOLD_SIMD_INLINE Bits opposite(Bits a) { return static_cast<Bits>(~a); }
BAGNOLD_SIMD_INLINE std::uint32_t to_integer(Bits m) { return m; }
BAGNOLD_SIMD_INLINE Register least(Register a, Register b) { return _mm512_maskz_min_pd(every_lane, a, b); }
BAGNOLD_SIMD_INLINE Register most(Register a, Register b) { return _mm512_maskz_max_pd(every_lane, a, b); }
BAGNOLD_SIMD_INLINE Register magnitude(Register a) { return _mm512_abs_pd(a); }

// 1/sqrt(1 - e) = 1 + e/2 + 3 e^2/8 + 5 e^3/16 + O(e^4), with e = 1 - a y^2 < 2^-13 for the 14-bit estimate y.
BAGNOLD_SIMD_INLINE Register inverse_root(Register a) {
  const Register y = _mm512_maskz_rsqrt14_pd(every_lane, a), e = 1.0 - (a * y) * y;
  const Register series = (0.3125 * e + 0.375) * e + 0.5;
  return series * (e * y) + y;
}
// 1/(1 - e) = (1 + e) (1 + e^2) + O(e^4), with e = 1 - a y < 2^-13 for the 14-bit estimate y.
BAGNOLD_SIMD_INLINE Register reciprocal(Register a) {
  const Register y = _mm512_maskz_rcp14_pd(every_lane, a), e = 1.0 - a * y, z = y * e + y;
  return z * (e * e) + z;
}
// One Newton step on a y removes the last rounding error; tiny keeps 0 * infinity out.
BAGNOLD_SIMD_INLINE Register root(Register a) {
  const Register b = most(a, eight(1e-300)), y = inverse_root(b), s = b * y;
  return blend(less(Register{}, a), s + (0.5 * y) * (b - s * s), Register{});
}
BAGNOLD_SIMD_INLINE Register ieee_root(Register a) { return _mm512_maskz_sqrt_pd(every_lane, a); }

// 2^n from n + integer_bits (core/exponential.hpp).
BAGNOLD_SIMD_INLINE Register power_from_bits(Register a) {
  const __m512i biased = _mm512_add_epi64(_mm512_castpd_si512(a), _mm512_set1_epi64(1023));
  return _mm512_castsi512_pd(_mm512_maskz_slli_epi64(every_lane, biased, 52));
}
BAGNOLD_SIMD_INLINE Register gather(const double* base, const std::uint32_t* index) {
  const __m256i where = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(index));
  return _mm512_mask_i32gather_pd(Register{}, every_lane, where, base, 8);
}
BAGNOLD_SIMD_INLINE void compress(std::uint32_t bits, const std::uint32_t* in, std::uint32_t* out) {
  const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(in));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm256_maskz_compress_epi32(static_cast<Bits>(bits), all));
}

// Lanes of a and b, counted through: 0 .. 7 are those of a.
template <int... from>
BAGNOLD_SIMD_INLINE Register shuffle(Register a, Register b) {
  return __builtin_shufflevector(a, b, from...);
}

// row[k]: four numbers of thing k in its low half, of thing k + 4 in its high one; column[c]: number c of all things.
BAGNOLD_SIMD_INLINE void transpose4(const Register (&row)[4], Register (&column)[4]) {
  const Register even01 = shuffle<0, 8, 2, 10, 4, 12, 6, 14>(row[0], row[1]),
                 even23 = shuffle<0, 8, 2, 10, 4, 12, 6, 14>(row[2], row[3]),
                 odd01 = shuffle<1, 9, 3, 11, 5, 13, 7, 15>(row[0], row[1]),
                 odd23 = shuffle<1, 9, 3, 11, 5, 13, 7, 15>(row[2], row[3]);
  column[0] = shuffle<0, 1, 8, 9, 4, 5, 12, 13>(even01, even23);
  column[1] = shuffle<0, 1, 8, 9, 4, 5, 12, 13>(odd01, odd23);
  column[2] = shuffle<2, 3, 10, 11, 6, 7, 14, 15>(even01, even23);
  column[3] = shuffle<2, 3, 10, 11, 6, 7, 14, 15>(odd01, odd23);
}
// The same with the things in another order, 0 1 4 5 2 3 6 7: the shuffles are cheaper.
BAGNOLD_SIMD_INLINE void transpose4_any_order(const Register (&row)[4], Register (&column)[4]) {
  const Register even01 = shuffle<0, 8, 2, 10, 4, 12, 6, 14>(row[0], row[1]),
                 even23 = shuffle<0, 8, 2, 10, 4, 12, 6, 14>(row[2], row[3]),
                 odd01 = shuffle<1, 9, 3, 11, 5, 13, 7, 15>(row[0], row[1]),
                 odd23 = shuffle<1, 9, 3, 11, 5, 13, 7, 15>(row[2], row[3]);
  column[0] = shuffle<0, 1, 4, 5, 8, 9, 12, 13>(even01, even23);
  column[1] = shuffle<0, 1, 4, 5, 8, 9, 12, 13>(odd01, odd23);
  column[2] = shuffle<2, 3, 6, 7, 10, 11, 14, 15>(even01, even23);
  column[3] = shuffle<2, 3, 6, 7, 10, 11, 14, 15>(odd01, odd23);
}
// Eight rows of eight.
BAGNOLD_SIMD_INLINE void transpose8(const Register (&row)[8], Register (&column)[8]) {
  for (int parity = 0; parity < 2; ++parity) {
    Register pair[4];
    for (int k = 0; k < 4; ++k)
      pair[k] = parity == 0 ? shuffle<0, 8, 2, 10, 4, 12, 6, 14>(row[2 * k], row[2 * k + 1])
                            : shuffle<1, 9, 3, 11, 5, 13, 7, 15>(row[2 * k], row[2 * k + 1]);
    const Register a = shuffle<0, 1, 8, 9, 2, 3, 10, 11>(pair[0], pair[1]),
                   b = shuffle<0, 1, 8, 9, 2, 3, 10, 11>(pair[2], pair[3]),
                   c = shuffle<4, 5, 12, 13, 6, 7, 14, 15>(pair[0], pair[1]),
                   d = shuffle<4, 5, 12, 13, 6, 7, 14, 15>(pair[2], pair[3]);
    column[parity] = shuffle<0, 1, 2, 3, 8, 9, 10, 11>(a, b);
    column[parity + 2] = shuffle<4, 5, 6, 7, 12, 13, 14, 15>(a, b);
    column[parity + 4] = shuffle<0, 1, 2, 3, 8, 9, 10, 11>(c, d);
    column[parity + 6] = shuffle<4, 5, 6, 7, 12, 13, 14, 15>(c, d);
  }
}
// Sum of the lanes of each of four registers.
BAGNOLD_SIMD_INLINE Four lane_sums(Register a, Register b, Register c, Register d) {
  const Register ab = shuffle<0, 8, 2, 10, 4, 12, 6, 14>(a, b) + shuffle<1, 9, 3, 11, 5, 13, 7, 15>(a, b),
                 cd = shuffle<0, 8, 2, 10, 4, 12, 6, 14>(c, d) + shuffle<1, 9, 3, 11, 5, 13, 7, 15>(c, d),
                 all = shuffle<0, 1, 8, 9, 4, 5, 12, 13>(ab, cd) + shuffle<2, 3, 10, 11, 6, 7, 14, 15>(ab, cd);
  return low_half(all) + high_half(all);
}
// { a - b of the low half, a + b of the high half }
BAGNOLD_SIMD_INLINE Register subtract_then_add(Register a, Register b) {
  return b * eight(-1, -1, -1, -1, 1, 1, 1, 1) + a;
}

}  // namespace bagnold::inline BAGNOLD_SIMD_VARIANT::simd

// A pack of eight numbers that behaves like one: the laws, written for any number type, run on it unchanged. It lies in
// the registers there are: one of AVX-512, two of AVX2 or four of SSE2, whose operations are in core/simd/. What is done
// with them is written once, here.
#pragma once
#include <cmath>
#include <cstdint>

#include "core/exponential.hpp"

#define BAGNOLD_SIMD_INLINE \
  [[gnu::always_inline]] inline  // a pack passed on in memory costs more than what is done with it

// The name of the variant is part of every symbol, so that builds of two variants can be linked together.
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#define BAGNOLD_SIMD_VARIANT avx512
#include "core/simd/avx512.hpp"
#elif defined(__AVX2__) && defined(__FMA__)
#define BAGNOLD_SIMD_VARIANT avx2
#include "core/simd/avx2.hpp"
#else
#define BAGNOLD_SIMD_VARIANT baseline
#include "core/simd/sse2.hpp"
#endif

namespace bagnold {
inline namespace BAGNOLD_SIMD_VARIANT {

using simd::Register;

struct Mask {
  simd::Bits m;
  BAGNOLD_SIMD_INLINE friend Mask operator&(const Mask& a, const Mask& b) { return {simd::both(a.m, b.m)}; }
  BAGNOLD_SIMD_INLINE friend Mask operator|(const Mask& a, const Mask& b) { return {simd::either(a.m, b.m)}; }
  BAGNOLD_SIMD_INLINE friend Mask operator!(const Mask& a) { return {simd::opposite(a.m)}; }
};

// Eight numbers.
struct Pack {
  static constexpr int lanes = 8;
  Register v;

  Pack() = default;
  BAGNOLD_SIMD_INLINE Pack(double a) : v(simd::eight(a)) {}
  BAGNOLD_SIMD_INLINE Pack(double a, double b, double c, double d, double e, double f, double g, double h)
      : v(simd::eight(a, b, c, d, e, f, g, h)) {}
  BAGNOLD_SIMD_INLINE explicit Pack(Register r) : v(r) {}
  BAGNOLD_SIMD_INLINE static Pack load(const double* p) { return Pack(simd::load_eight(p)); }  // aligned to 64 bytes
  BAGNOLD_SIMD_INLINE static Pack load_unaligned(const double* p) { return Pack(simd::load_eight_unaligned(p)); }
  BAGNOLD_SIMD_INLINE void store(double* p) const { simd::store(p, v); }
  BAGNOLD_SIMD_INLINE void store_unaligned(double* p) const { simd::store_unaligned(p, v); }
  BAGNOLD_SIMD_INLINE double operator[](int lane) const { return simd::lane(v, lane); }
  BAGNOLD_SIMD_INLINE void set(int lane, double a) { simd::set_lane(v, lane, a); }

  BAGNOLD_SIMD_INLINE friend Pack operator+(const Pack& a, const Pack& b) { return Pack(a.v + b.v); }
  BAGNOLD_SIMD_INLINE friend Pack operator-(const Pack& a, const Pack& b) { return Pack(a.v - b.v); }
  BAGNOLD_SIMD_INLINE friend Pack operator*(const Pack& a, const Pack& b) { return Pack(a.v * b.v); }
  BAGNOLD_SIMD_INLINE friend Pack operator/(const Pack& a, const Pack& b) { return Pack(a.v / b.v); }
  BAGNOLD_SIMD_INLINE friend Pack operator-(const Pack& a) { return Pack(-a.v); }
  BAGNOLD_SIMD_INLINE Pack& operator+=(const Pack& a) { return *this = *this + a; }
  BAGNOLD_SIMD_INLINE Pack& operator-=(const Pack& a) { return *this = *this - a; }
  BAGNOLD_SIMD_INLINE Pack& operator*=(const Pack& a) { return *this = *this * a; }
  BAGNOLD_SIMD_INLINE friend Pack min(const Pack& a, const Pack& b) { return Pack(simd::least(a.v, b.v)); }
  BAGNOLD_SIMD_INLINE friend Pack max(const Pack& a, const Pack& b) { return Pack(simd::most(a.v, b.v)); }
  BAGNOLD_SIMD_INLINE friend Pack abs(const Pack& a) { return Pack(simd::magnitude(a.v)); }
  BAGNOLD_SIMD_INLINE friend Pack sqrt(const Pack& a) { return Pack(simd::root(a.v)); }
  BAGNOLD_SIMD_INLINE friend Pack rsqrt(const Pack& a) { return Pack(simd::inverse_root(a.v)); }
  // The processor's own, correctly rounded square root: keeps the multipliers free, where sqrt() keeps the divider free.
  BAGNOLD_SIMD_INLINE friend Pack ieee_sqrt(const Pack& a) { return Pack(simd::ieee_root(a.v)); }
  friend Pack power(Pack a, double exponent) {
    for (int k = 0; k < lanes; ++k) a.set(k, std::pow(a[k], exponent));
    return a;
  }
  BAGNOLD_SIMD_INLINE friend Pack reciprocal(const Pack& a) { return Pack(simd::reciprocal(a.v)); }
  BAGNOLD_SIMD_INLINE friend Mask operator<(const Pack& a, const Pack& b) { return {simd::less(a.v, b.v)}; }
  BAGNOLD_SIMD_INLINE friend Mask operator>(const Pack& a, const Pack& b) { return b < a; }
  // a b + c, fused where the build has the instruction: for functions of one number, not for sums that must be symmetric.
  BAGNOLD_SIMD_INLINE friend Pack mul_add(const Pack& a, const Pack& b, const Pack& c) {
    return Pack(simd::fused(a.v, b.v, c.v));
  }
  BAGNOLD_SIMD_INLINE friend Pack select(const Mask& m, const Pack& a, const Pack& b) {
    return Pack(simd::blend(m.m, a.v, b.v));
  }
};

// Bit k is lane k.
BAGNOLD_SIMD_INLINE std::uint32_t to_integer(const Mask& m) { return simd::to_integer(m.m); }
BAGNOLD_SIMD_INLINE bool any(const Mask& m) { return to_integer(m) != 0; }
constexpr bool worthwhile(const Mask&) { return true; }
// Lanes begin .. end - 1; both may lie outside the pack.
BAGNOLD_SIMD_INLINE Mask lanes_between(int begin, int end) {
  const Pack index(0, 1, 2, 3, 4, 5, 6, 7);
  return (index > Pack(begin - 0.5)) & (index < Pack(end - 0.5));
}
// Writes the lanes of the mask, at any address; the others stay as they are.
BAGNOLD_SIMD_INLINE void store_where(const Mask& mask, const Pack& a, double* p) { simd::store_where(p, mask.m, a.v); }
inline double largest(const Pack& a) {
  double m = a[0];
  for (int k = 1; k < Pack::lanes; ++k) m = a[k] > m ? a[k] : m;
  return m;
}

// Writes the numbers whose bit is set to the front of `out`, which has room for eight; returns how many.
BAGNOLD_SIMD_INLINE int compress(std::uint32_t bits, const std::uint32_t* in, std::uint32_t* out) {
  simd::compress(bits, in, out);
  return __builtin_popcount(bits);
}

// Sum of the lanes, always in the same order.
BAGNOLD_SIMD_INLINE double lane_sum(const Pack& a) {
  const simd::Four s = simd::low_half(a.v) + simd::high_half(a.v);
  return (simd::lane(s, 0) + simd::lane(s, 1)) + (simd::lane(s, 2) + simd::lane(s, 3));
}
// The lane sums of `count` packs, four at a time, always in the same order.
inline void lane_sums(const Pack* a, int count, double* sums) {
  int k = 0;
  for (; k + 4 <= count; k += 4)
    simd::store_unaligned(sums + k, simd::lane_sums(a[k].v, a[k + 1].v, a[k + 2].v, a[k + 3].v));
  if (k == count) return;
  const auto at = [&](int i) { return i < count ? a[i].v : Register{}; };
  const simd::Four rest = simd::lane_sums(at(k), at(k + 1), at(k + 2), at(k + 3));
  for (int i = 0; k < count; ++i, ++k) sums[k] = simd::lane(rest, i);
}
template <int N>
inline void lane_sums(const Pack (&a)[N], double* sums) {
  lane_sums(a, N, sums);
}

// base[index[k]] in lane k.
BAGNOLD_SIMD_INLINE Pack gather(const double* base, const std::uint32_t* index) {
  return Pack(simd::gather(base, index));
}

// As for double: the integer nearest to a, for |a| < 2^51, and 2^n for an integer n of -1022 to 1023.
BAGNOLD_SIMD_INLINE Pack nearest_integer(const Pack& a) { return (a + integer_bits) - integer_bits; }
BAGNOLD_SIMD_INLINE Pack power_of_two(const Pack& n) { return Pack(simd::power_from_bits((n + integer_bits).v)); }

}  // namespace BAGNOLD_SIMD_VARIANT
}  // namespace bagnold

#undef BAGNOLD_SIMD_INLINE
#undef BAGNOLD_SIMD_VARIANT

// A pack as two halves of four numbers, from the operations on halves.
#pragma once
#include <cstdint>

namespace bagnold::inline BAGNOLD_SIMD_VARIANT::simd {

struct alignas(64) Register {
  Four lo, hi;
};
struct Bits {
  FourBits lo, hi;
};

BAGNOLD_SIMD_INLINE Register operator+(Register a, Register b) { return {a.lo + b.lo, a.hi + b.hi}; }
BAGNOLD_SIMD_INLINE Register operator-(Register a, Register b) { return {a.lo - b.lo, a.hi - b.hi}; }
BAGNOLD_SIMD_INLINE Register operator*(Register a, Register b) { return {a.lo * b.lo, a.hi * b.hi}; }
BAGNOLD_SIMD_INLINE Register operator/(Register a, Register b) { return {a.lo / b.lo, a.hi / b.hi}; }
BAGNOLD_SIMD_INLINE Register operator-(Register a) { return {-a.lo, -a.hi}; }

BAGNOLD_SIMD_INLINE Register eight(double a) { return {four(a), four(a)}; }
BAGNOLD_SIMD_INLINE Register eight(double a, double b, double c, double d, double e, double f, double g, double h) {
  return {four(a, b, c, d), four(e, f, g, h)};
}
BAGNOLD_SIMD_INLINE Register halves(Four low, Four high) { return {low, high}; }
BAGNOLD_SIMD_INLINE Four low_half(Register a) { return a.lo; }
BAGNOLD_SIMD_INLINE Four high_half(Register a) { return a.hi; }
BAGNOLD_SIMD_INLINE Register load_eight(const double* p) { return {load_four(p), load_four(p + 4)}; }
BAGNOLD_SIMD_INLINE Register load_eight_unaligned(const double* p) {
  return {load_four_unaligned(p), load_four_unaligned(p + 4)};
}
BAGNOLD_SIMD_INLINE void store(double* p, Register a) {
  store(p, a.lo);
  store(p + 4, a.hi);
}
BAGNOLD_SIMD_INLINE void store_unaligned(double* p, Register a) {
  store_unaligned(p, a.lo);
  store_unaligned(p + 4, a.hi);
}
BAGNOLD_SIMD_INLINE double lane(Register a, int k) { return k < 4 ? lane(a.lo, k) : lane(a.hi, k - 4); }
BAGNOLD_SIMD_INLINE void set_lane(Register& a, int k, double value) {
  alignas(64) double all[8];
  store(all, a);
  all[k] = value;
  a = load_eight(all);
}

BAGNOLD_SIMD_INLINE Register fused(Register a, Register b, Register c) {
  return {fused(a.lo, b.lo, c.lo), fused(a.hi, b.hi, c.hi)};
}
BAGNOLD_SIMD_INLINE Bits less(Register a, Register b) { return {less(a.lo, b.lo), less(a.hi, b.hi)}; }
BAGNOLD_SIMD_INLINE Register blend(Bits m, Register a, Register b) {
  return {blend(m.lo, a.lo, b.lo), blend(m.hi, a.hi, b.hi)};
}
BAGNOLD_SIMD_INLINE Bits both(Bits a, Bits b) { return {both(a.lo, b.lo), both(a.hi, b.hi)}; }
BAGNOLD_SIMD_INLINE Bits either(Bits a, Bits b) { return {either(a.lo, b.lo), either(a.hi, b.hi)}; }
BAGNOLD_SIMD_INLINE Bits opposite(Bits a) { return {opposite(a.lo), opposite(a.hi)}; }
BAGNOLD_SIMD_INLINE std::uint32_t to_integer(Bits m) { return to_integer(m.lo) | to_integer(m.hi) << 4; }
BAGNOLD_SIMD_INLINE Register least(Register a, Register b) { return {least(a.lo, b.lo), least(a.hi, b.hi)}; }
BAGNOLD_SIMD_INLINE Register most(Register a, Register b) { return {most(a.lo, b.lo), most(a.hi, b.hi)}; }
BAGNOLD_SIMD_INLINE Register magnitude(Register a) { return {magnitude(a.lo), magnitude(a.hi)}; }
BAGNOLD_SIMD_INLINE Register root(Register a) { return {root(a.lo), root(a.hi)}; }
BAGNOLD_SIMD_INLINE Register ieee_root(Register a) { return root(a); }
BAGNOLD_SIMD_INLINE Register inverse_root(Register a) { return {inverse_root(a.lo), inverse_root(a.hi)}; }
BAGNOLD_SIMD_INLINE Register reciprocal(Register a) { return {reciprocal(a.lo), reciprocal(a.hi)}; }
BAGNOLD_SIMD_INLINE Register power_from_bits(Register a) { return {power_from_bits(a.lo), power_from_bits(a.hi)}; }

// Nearly always all lanes: a masked store is far dearer than a plain one on some processors.
BAGNOLD_SIMD_INLINE void store_where(double* p, Bits m, Register a) {
  if (to_integer(m) == 0xff) return store_unaligned(p, a);
  store_where(p, m.lo, a.lo);
  store_where(p + 4, m.hi, a.hi);
}
// Number by number: the instructions for it are no faster on most of these processors, and far slower on some.
BAGNOLD_SIMD_INLINE Register gather(const double* base, const std::uint32_t* index) {
  return eight(base[index[0]], base[index[1]], base[index[2]], base[index[3]], base[index[4]], base[index[5]],
               base[index[6]], base[index[7]]);
}

// Lanes of a and b, counted through: 0 .. 7 are those of a. Each half of the result comes from one half of each.
template <int k0, int k1, int k2, int k3, int k4, int k5, int k6, int k7>
BAGNOLD_SIMD_INLINE Register shuffle(Register a, Register b) {
  const auto half = [&]<int... from>() __attribute__((always_inline)) {
    constexpr bool a_is_high = ((from < 8 && from / 4 == 1) || ...), b_is_high = ((from >= 8 && from / 4 == 3) || ...);
    static_assert(((from / 4 == (from < 8 ? 0 + a_is_high : 2 + b_is_high)) && ...), "one half of each");
    return shuffle<(from < 8 ? from % 4 : 4 + from % 4)...>(a_is_high ? a.hi : a.lo, b_is_high ? b.hi : b.lo);
  };
  return {half.template operator()<k0, k1, k2, k3>(), half.template operator()<k4, k5, k6, k7>()};
}

// row[k]: four numbers of thing k in its low half, of thing k + 4 in its high one; column[c]: number c of all things.
BAGNOLD_SIMD_INLINE void transpose4(const Register (&row)[4], Register (&column)[4]) {
  Four low[4] = {row[0].lo, row[1].lo, row[2].lo, row[3].lo}, high[4] = {row[0].hi, row[1].hi, row[2].hi, row[3].hi};
  transpose4x4(low);
  transpose4x4(high);
  column[0] = {low[0], high[0]};
  column[1] = {low[1], high[1]};
  column[2] = {low[2], high[2]};
  column[3] = {low[3], high[3]};
}
BAGNOLD_SIMD_INLINE void transpose4_any_order(const Register (&row)[4], Register (&column)[4]) {
  transpose4(row, column);
}
// Eight rows of eight.
BAGNOLD_SIMD_INLINE void transpose8(const Register (&row)[8], Register (&column)[8]) {
  Four a[4] = {row[0].lo, row[1].lo, row[2].lo, row[3].lo}, b[4] = {row[4].lo, row[5].lo, row[6].lo, row[7].lo},
       c[4] = {row[0].hi, row[1].hi, row[2].hi, row[3].hi}, d[4] = {row[4].hi, row[5].hi, row[6].hi, row[7].hi};
  transpose4x4(a);
  transpose4x4(b);
  transpose4x4(c);
  transpose4x4(d);
  column[0] = {a[0], b[0]};
  column[1] = {a[1], b[1]};
  column[2] = {a[2], b[2]};
  column[3] = {a[3], b[3]};
  column[4] = {c[0], d[0]};
  column[5] = {c[1], d[1]};
  column[6] = {c[2], d[2]};
  column[7] = {c[3], d[3]};
}
// Sum of the lanes of each of four registers.
BAGNOLD_SIMD_INLINE Four lane_sums(Register a, Register b, Register c, Register d) {
  return lane_sums(a.lo + a.hi, b.lo + b.hi, c.lo + c.hi, d.lo + d.hi);
}
// { a - b of the low half, a + b of the high half }
BAGNOLD_SIMD_INLINE Register subtract_then_add(Register a, Register b) { return {a.lo - b.lo, a.hi + b.hi}; }

}  // namespace bagnold::inline BAGNOLD_SIMD_VARIANT::simd

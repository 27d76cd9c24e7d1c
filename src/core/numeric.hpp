// What a law written once for any number type may use: arithmetic, comparisons, and these functions. Here for
// double; a pack of numbers (a SIMD register) brings its own overloads, found by argument-dependent lookup, and a
// comparison of packs gives a mask that `select` takes.
#pragma once
#include <cmath>

#include "core/vec3.hpp"

namespace bagnold {

constexpr double select(bool mask, double if_true, double if_false) { return mask ? if_true : if_false; }
// Whether work that only matters where `mask` holds is to be done. Among the lanes of a pack it nearly always is.
constexpr bool worthwhile(bool mask) { return mask; }
constexpr double min(double a, double b) { return b < a ? b : a; }
constexpr double max(double a, double b) { return a < b ? b : a; }
inline double sqrt(double a) { return std::sqrt(a); }
inline double ieee_sqrt(double a) { return std::sqrt(a); }
inline double rsqrt(double a) { return 1 / std::sqrt(a); }
inline double power(double a, double exponent) { return std::pow(a, exponent); }
constexpr double reciprocal(double a) { return 1 / a; }
inline double abs(double a) { return std::fabs(a); }
constexpr bool any(bool mask) { return mask; }
// a b + c, fused where the build has the instruction.
inline double mul_add(double a, double b, double c) {
#ifdef __FMA__
  return __builtin_fma(a, b, c);
#else
  return a * b + c;
#endif
}

// A vector whose components are of any number type.
template <class N>
struct Vec3Of {
  N x, y, z;
};

template <class N>
constexpr Vec3Of<N> operator+(const Vec3Of<N>& a, const Vec3Of<N>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class N>
constexpr Vec3Of<N> operator-(const Vec3Of<N>& a, const Vec3Of<N>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class N>
constexpr Vec3Of<N> operator*(const N& s, const Vec3Of<N>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class N>
constexpr N dot(const Vec3Of<N>& a, const Vec3Of<N>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class N>
constexpr Vec3Of<N> cross(const Vec3Of<N>& a, const Vec3Of<N>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Mask, class N>
constexpr Vec3Of<N> select(const Mask& mask, const Vec3Of<N>& a, const Vec3Of<N>& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

constexpr Vec3Of<double> numbers(const Vec3& a) { return {a.x, a.y, a.z}; }
constexpr Vec3 vec3(const Vec3Of<double>& a) { return {a.x, a.y, a.z}; }

}  // namespace bagnold

// Vectors and 3x3 tensors: plain data, free functions.
#pragma once
#include <array>
#include <cmath>

namespace bagnold {

struct Vec3 {
  double x = 0, y = 0, z = 0;
  constexpr double& operator[](int k) { return k == 0 ? x : k == 1 ? y : z; }
  constexpr double operator[](int k) const { return k == 0 ? x : k == 1 ? y : z; }
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

constexpr Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(double s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
constexpr Vec3 operator*(const Vec3& a, double s) { return s * a; }
constexpr Vec3 operator/(const Vec3& a, double s) { return {a.x / s, a.y / s, a.z / s}; }
constexpr Vec3& operator+=(Vec3& a, const Vec3& b) { return a = a + b; }
constexpr Vec3& operator-=(Vec3& a, const Vec3& b) { return a = a - b; }
constexpr Vec3& operator*=(Vec3& a, double s) { return a = s * a; }

constexpr double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
constexpr double norm2(const Vec3& a) { return dot(a, a); }
inline double norm(const Vec3& a) { return std::sqrt(norm2(a)); }

// Row-major 3x3 tensor; t(a, b) is the component in row a, column b.
struct Tensor3 {
  std::array<double, 9> v{};
  constexpr double& operator()(int a, int b) { return v[static_cast<std::size_t>(3 * a + b)]; }
  constexpr double operator()(int a, int b) const { return v[static_cast<std::size_t>(3 * a + b)]; }
  friend constexpr bool operator==(const Tensor3&, const Tensor3&) = default;
};

constexpr Tensor3 operator+(Tensor3 a, const Tensor3& b) {
  for (std::size_t k = 0; k < 9; ++k) a.v[k] += b.v[k];
  return a;
}
constexpr Tensor3 operator*(double s, Tensor3 a) {
  for (double& c : a.v) c *= s;
  return a;
}
constexpr Tensor3& operator+=(Tensor3& a, const Tensor3& b) { return a = a + b; }
constexpr Tensor3 outer(const Vec3& a, const Vec3& b) {
  Tensor3 t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t(i, j) = a[i] * b[j];
  return t;
}
constexpr double trace(const Tensor3& t) { return t(0, 0) + t(1, 1) + t(2, 2); }

}  // namespace bagnold

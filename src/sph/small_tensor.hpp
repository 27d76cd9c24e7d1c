// Tensors of two or three dimensions held in plain arrays, row by row.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

namespace bagnold::sph {

template <int D>
using Matrix = std::array<double, D * D>;

template <int D>
inline Matrix<D> product(const Matrix<D>& a, const Matrix<D>& b) {
  Matrix<D> c{};
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j)
      for (int k = 0; k < D; ++k) c[i * D + j] += a[i * D + k] * b[k * D + j];
  return c;
}

// Symmetric matrix from its upper triangle, row by row.
template <int D>
inline Matrix<D> from_upper(const double* upper) {
  Matrix<D> m{};
  for (int i = 0, q = 0; i < D; ++i)
    for (int j = i; j < D; ++j, ++q) m[i * D + j] = m[j * D + i] = upper[q];
  return m;
}

// Smallest eigenvalue of a symmetric matrix.
inline double smallest_eigenvalue(const Matrix<2>& m) {
  const double mean = 0.5 * (m[0] + m[3]), half = 0.5 * (m[0] - m[3]);
  return mean - std::sqrt(half * half + m[1] * m[1]);
}
inline double smallest_eigenvalue(const Matrix<3>& m) {
  const double q = (m[0] + m[4] + m[8]) / 3, off = m[1] * m[1] + m[2] * m[2] + m[5] * m[5];
  const double a = m[0] - q, b = m[4] - q, c = m[8] - q;
  const double p = std::sqrt((a * a + b * b + c * c + 2 * off) / 6);
  if (!(p > 1e-15 * std::abs(q))) return q;
  const double det = a * (b * c - m[5] * m[5]) - m[1] * (m[1] * c - m[5] * m[2]) + m[2] * (m[1] * m[5] - b * m[2]);
  const double angle = std::acos(std::clamp(det / (2 * p * p * p), -1.0, 1.0)) / 3;
  return q + 2 * p * std::cos(angle + 2 * M_PI / 3);
}

// sqrt(2 e:e) of the symmetric part of L, with the hoop rate of axisymmetric flow.
template <int D>
inline double shear_rate(const Matrix<D>& L, double hoop) {
  double sum = hoop * hoop;
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) {
      const double e = 0.5 * (L[a * D + b] + L[b * D + a]);
      sum += e * e;
    }
  return std::sqrt(2 * sum);
}

// Inverse of a matrix that has one.
inline Matrix<2> inverse(const Matrix<2>& m) {
  const double d = 1 / (m[0] * m[3] - m[1] * m[2]);
  return {m[3] * d, -m[1] * d, -m[2] * d, m[0] * d};
}
inline Matrix<3> inverse(const Matrix<3>& m) {
  const Matrix<3> c{m[4] * m[8] - m[5] * m[7], m[2] * m[7] - m[1] * m[8], m[1] * m[5] - m[2] * m[4],
                    m[5] * m[6] - m[3] * m[8], m[0] * m[8] - m[2] * m[6], m[2] * m[3] - m[0] * m[5],
                    m[3] * m[7] - m[4] * m[6], m[1] * m[6] - m[0] * m[7], m[0] * m[4] - m[1] * m[3]};
  const double d = 1 / (m[0] * c[0] + m[1] * c[3] + m[2] * c[6]);
  Matrix<3> r = c;
  for (double& x : r) x *= d;
  return r;
}

}  // namespace bagnold::sph

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

inline double determinant(const Matrix<2>& m) { return m[0] * m[3] - m[1] * m[2]; }
inline double determinant(const Matrix<3>& m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) + m[1] * (m[5] * m[6] - m[3] * m[8]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
}

// cos(3 theta) of the symmetric part of L (and the hoop rate), compression positive: 1 in triaxial compression, 0 in
// plane shear of constant volume, -1 in triaxial extension; 0 where nothing shears.
template <int D>
inline double lode_parameter(const Matrix<D>& L, double hoop) {
  double mean = D == 2 ? hoop : 0, square = 0;
  for (int a = 0; a < D; ++a) mean += L[a * D + a];
  mean /= 3;
  Matrix<D> e;
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) {
      const int k = a * D + b;
      e[k] = 0.5 * (L[k] + L[b * D + a]) - (a == b ? mean : 0);
      square += e[k] * e[k];
    }
  const double out_of_plane = D == 2 ? hoop - mean : 1;
  if constexpr (D == 2) square += out_of_plane * out_of_plane;
  const double norm = std::sqrt(square / 2), cube = norm * norm * norm;
  return cube > 0 ? std::clamp(-1.5 * std::sqrt(3.0) * determinant(e) * out_of_plane / cube, -1.0, 1.0) : 0;
}

// Inverse of a matrix that has one.
inline Matrix<2> inverse(const Matrix<2>& m) {
  const double d = 1 / determinant(m);
  return {m[3] * d, -m[1] * d, -m[2] * d, m[0] * d};
}
inline Matrix<3> inverse(const Matrix<3>& m) {
  const Matrix<3> c{m[4] * m[8] - m[5] * m[7], m[2] * m[7] - m[1] * m[8], m[1] * m[5] - m[2] * m[4],
                    m[5] * m[6] - m[3] * m[8], m[0] * m[8] - m[2] * m[6], m[2] * m[3] - m[0] * m[5],
                    m[3] * m[7] - m[4] * m[6], m[1] * m[6] - m[0] * m[7], m[0] * m[4] - m[1] * m[3]};
  const double d = 1 / determinant(m);
  Matrix<3> r = c;
  for (double& x : r) x *= d;
  return r;
}

// The rotation v = G r that fits the velocities of neighbours best: S = sum A f v r, M = sum A f r r. S = G M gives G back.
inline Matrix<2> best_rotation(const Matrix<2>& M, const Matrix<2>& S) {
  const double rate = (S[2] - S[1]) / (M[0] + M[3] + 1e-300);  // a lone particle does not turn
  return {0, -rate, rate, 0};
}
inline Matrix<3> best_rotation(const Matrix<3>& M, const Matrix<3>& S) {
  const double trace = M[0] + M[4] + M[8];
  Matrix<3> inertia;
  for (std::size_t k = 0; k < 9; ++k) inertia[k] = (k % 4 == 0 ? trace + 1e-90 : 0) - M[k];
  // A string of particles shows no rotation about itself: any resistance to it will do.
  if (!(determinant(inertia) > 1e-9 * trace * trace * trace))
    for (std::size_t k = 0; k < 9; ++k) inertia[k] += M[k];
  const Matrix<3> K = inverse(inertia);
  const std::array<double, 3> moment{S[7] - S[5], S[2] - S[6], S[3] - S[1]};
  std::array<double, 3> w{};
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b) w[a] += K[3 * a + b] * moment[b];
  return {0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0};
}

// Where B is not M^-1 the gradient S B of a rotation is not the rotation; what it lacks is added, G (1 - M B) with the best
// rotation G. The adjoint of S -> gradient(S), of a stress T, is T B + best_rotation(M, T (1 - M B)).
template <int D>
inline Matrix<D> rest(const Matrix<D>& M, const Matrix<D>& B) {  // 1 - M B
  Matrix<D> r = product<D>(M, B);
  for (int k = 0; k < D * D; ++k) r[k] = (k % (D + 1) == 0 ? 1 : 0) - r[k];
  return r;
}
template <int D>
inline Matrix<D> gradient(const Matrix<D>& S, const Matrix<D>& M, const Matrix<D>& B) {
  Matrix<D> L = product<D>(S, B);
  const Matrix<D> missing = product<D>(best_rotation(M, S), rest<D>(M, B));
  for (int k = 0; k < D * D; ++k) L[k] += missing[k];
  return L;
}
template <int D>
inline Matrix<D> gradient_adjoint(const Matrix<D>& T, const Matrix<D>& M, const Matrix<D>& B) {
  Matrix<D> r = product<D>(T, B);
  const Matrix<D> G = best_rotation(M, product<D>(T, rest<D>(M, B)));
  for (int k = 0; k < D * D; ++k) r[k] += G[k];
  return r;
}

}  // namespace bagnold::sph

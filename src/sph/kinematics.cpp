#include "sph/kinematics.hpp"

#include "core/parallel.hpp"
#include "sph/dispatch.hpp"
#include "sph/ghosts.hpp"
#include "sph/small_tensor.hpp"

namespace bagnold::sph {
namespace {

// B = M^-1, blended to 1 where the neighbourhood is too thin for an inverse to mean anything.
constexpr double blend_from = 0.3, blend_to = 0.5;

// Sums over the neighbours of one particle.
template <int D>
struct Sums {
  double density = 0;                     // sum m_j f (v_ij . r_ij)
  Matrix<D> S{};                          // sum A_j f v_ij r_ij
  std::array<double, D*(D + 1) / 2> M{};  // sum A_j f r r, upper triangle
  std::array<double, D> imbalance{};
  double concentration = 0;
};

template <int D>
void write_records(Work& w, const Particles& p) {
  const std::int64_t n = p.size();
  w.slim.resize(w.pairs.elements(n));
  parallel_for(n, [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    double* to = w.slim.at(k);
    for (std::size_t d = 0; d < D; ++d) to[d] = p.x[d][i], to[D + d] = p.v[d][i];
    to[2 * D] = w.area[i];
    to[2 * D + 1] = p.mass[i];
  });
  fill_images(w.pairs, n, w.slim, [&](std::size_t image, const double* from, double* to) {
    const Images& m = w.pairs.images;
    for (std::size_t d = 0; d < D; ++d) {
      to[d] = m.R[image][d] * from[d] + m.shift[image][d];
      to[D + d] = m.S[image][d] * from[D + d];
    }
    to[2 * D] = from[2 * D];
    to[2 * D + 1] = from[2 * D + 1];
  });
  double* dummy = w.slim.at(w.pairs.elements(n) - 1);
  for (int d = 0; d < D; ++d) dummy[d] = 1e30, dummy[D + d] = 0;
  dummy[2 * D] = dummy[2 * D + 1] = 0;
}

template <int D, class Kernel, Kinematics what, bool moments>
Sums<D> sum_neighbours(Work& w, const PairShape<D, Kernel>& shape, std::int64_t i) {
  constexpr bool printed = what != Kinematics::corrected, gradients = what != Kinematics::density;
  const double* self = w.slim.at(i);
  Octet density{}, S[D * D]{}, M[D * (D + 1) / 2]{}, missing[D]{}, C{};
  for_each_octet(w.pairs, i, [&](const std::int32_t* j, std::size_t q) {
    Octet other[2 * D + 2], r[D], v[D];
    gather(w.slim, j, other);
    Octet r2{}, vr{};
    for (int d = 0; d < D; ++d) {
      r[d] = self[d] - other[d];
      v[d] = self[D + d] - other[D + d];
      r2 += r[d] * r[d];
      vr += v[d] * r[d];
    }
    const Octet R = shape.ratio(r2), f = shape.f(R), af = other[2 * D] * f;
    if constexpr (printed) density += other[2 * D + 1] * f * vr;
    if constexpr (what == Kinematics::corrected) {
      for (std::size_t d = 0; d < D; ++d) w.r[d][q] = r[d];
      w.f[q] = f;
    }
    if constexpr (gradients)
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) S[a * D + b] += af * v[a] * r[b];
    if constexpr (moments) {
      for (int a = 0, m = 0; a < D; ++a) {
        missing[a] += af * r[a];
        for (int b = a; b < D; ++b, ++m) M[m] += af * r[a] * r[b];
      }
      C += other[2 * D] * shape.w(R);
    }
  });
  Sums<D> sums;
  sums.density = lane_sum(density);
  for (std::size_t m = 0; m < D * D; ++m) sums.S[m] = lane_sum(S[m]);
  for (std::size_t m = 0; m < D * (D + 1) / 2; ++m) sums.M[m] = lane_sum(M[m]);
  for (std::size_t d = 0; d < D; ++d) sums.imbalance[d] = lane_sum(missing[d]);
  sums.concentration = lane_sum(C) + self[2 * D] * shape.w(0.0);
  return sums;
}

template <int D, class Kernel>
void add_ghosts(Sums<D>& sums, const PairShape<D, Kernel>& shape, const Model& model, const double* self) {
  std::array<double, D> x, v;
  for (std::size_t d = 0; d < D; ++d) x[d] = self[d], v[d] = self[D + d];
  const double area = self[2 * D], mass = self[2 * D + 1];
  for_each_ghost<D>(model, x, [&](const std::array<double, D>& r, double beta) {
    double r2 = 0, vr = 0;
    for (std::size_t d = 0; d < D; ++d) r2 += r[d] * r[d], vr += beta * v[d] * r[d];
    const double R = shape.ratio(r2), f = shape.f(R);
    sums.density += mass * f * vr;
    for (std::size_t a = 0, m = 0; a < D; ++a) {
      sums.imbalance[a] += area * f * r[a];
      for (std::size_t b = 0; b < D; ++b) sums.S[a * D + b] += area * f * beta * v[a] * r[b];
      for (std::size_t b = a; b < D; ++b, ++m) sums.M[m] += area * f * r[a] * r[b];
    }
    sums.concentration += area * shape.w(R);
  });
}

// sqrt(2 e:e) of the symmetric part of L, with the hoop rate of axisymmetric flow.
template <int D>
double shear_rate(const Matrix<D>& L, double hoop) {
  double sum = hoop * hoop;
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) {
      const double e = 0.5 * (L[a * D + b] + L[b * D + a]);
      sum += e * e;
    }
  return std::sqrt(2 * sum);
}

template <int D>
Matrix<D> correction(const Matrix<D>& M, double coverage) {
  const double weight = std::clamp((coverage - blend_from) / (blend_to - blend_from), 0.0, 1.0);
  Matrix<D> B{};
  if (weight > 0) B = inverse(M);
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) B[a * D + b] = weight * B[a * D + b] + (a == b ? 1 - weight : 0);
  return B;
}

template <int D, class Kernel, Kinematics what, bool moments>
void sweep(Work& w, const Particles& p, const Model& model) {
  const PairShape<D, Kernel> shape(model.h());
  const bool ghosts = model.floor && !model.corrected();
  parallel_for(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    Sums<D> s = sum_neighbours<D, Kernel, what, moments>(w, shape, k);
    if (ghosts && p.x[D - 1][i] < 2 * model.h()) add_ghosts(s, shape, model, w.slim.at(k));
    if constexpr (what != Kinematics::corrected) w.density_rate[i] = -s.density;
    const double hoop = model.axisymmetric ? p.v[0][i] * inverse_radius(model, p.x[0][i]) : 0;
    if constexpr (moments) {
      const Matrix<D> M = from_upper<D>(s.M.data());
      w.coverage[i] = smallest_eigenvalue(M);
      w.concentration[i] = s.concentration;
      for (std::size_t d = 0; d < D; ++d) w.imbalance[d][i] = s.imbalance[d];
      const Matrix<D> B = correction<D>(M, w.coverage[i]);
      std::copy(B.begin(), B.end(), w.correction.begin() + k * D * D);
      if constexpr (what == Kinematics::corrected) {
        const Matrix<D> L = product<D>(s.S, B);
        double divergence = hoop;
        for (int d = 0; d < D; ++d) divergence += L[d * D + d];
        w.density_rate[i] = -p.rho[i] * divergence;
        std::copy(L.begin(), L.end(), w.gradient.begin() + k * D * D);
        w.shear_rate[i] = shear_rate<D>(L, hoop);
      }
    }
    if constexpr (what == Kinematics::pairs) w.shear_rate[i] = shear_rate<D>(s.S, hoop);
  });
}

}  // namespace

void update_volumes(Work& w, const Particles& p, const Model& model) {
  parallel_for(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    w.volume[i] = p.mass[i] / p.rho[i];
    w.area[i] = model.axisymmetric ? w.volume[i] * inverse_radius(model, p.x[0][i]) / (2 * M_PI) : w.volume[i];
  });
}

void kinematics(Work& w, const Particles& p, const Model& model, Kinematics what, bool moments) {
  update_volumes(w, p, model);
  if (what == Kinematics::corrected) {
    for (std::size_t d = 0; d < static_cast<std::size_t>(model.dim); ++d)
      w.r[d].resize(w.pairs.index.size() / octet_size);
    w.f.resize(w.pairs.index.size() / octet_size);
  }
  dispatch(model, [&](auto dim, const auto& kernel) {
    constexpr int D = decltype(dim)::value;
    using Kernel = std::decay_t<decltype(kernel)>;
    write_records<D>(w, p);
    if (what == Kinematics::density)
      sweep<D, Kernel, Kinematics::density, false>(w, p, model);
    else if (what == Kinematics::corrected)
      sweep<D, Kernel, Kinematics::corrected, true>(w, p, model);
    else if (moments)
      sweep<D, Kernel, Kinematics::pairs, true>(w, p, model);
    else
      sweep<D, Kernel, Kinematics::pairs, false>(w, p, model);
  });
}

}  // namespace bagnold::sph

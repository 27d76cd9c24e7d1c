// Pressure and viscosity as derivatives of one discrete energy (docs/sph.md derives every line).
#include <algorithm>

#include "core/parallel.hpp"
#include "sph/dispatch.hpp"
#include "sph/forces.hpp"
#include "sph/kinematics.hpp"
#include "sph/small_tensor.hpp"

namespace bagnold::sph {
namespace {

// Fields of a record of the pressure sweep.
template <int D>
struct PressureRecord {
  static constexpr int area = 0, volume = 1, eta = 2, zeta = 3, P = 4, size = 4 + D * D;  // P = p V B
};
// Fields of the records of the three sweeps of the viscous force: velocities; gradients, `sign` turning tangential
// components of what an image hands to its parent (-1 under the no-slip floor); stresses T B.
template <int D>
struct GradientRecord {
  static constexpr int v = 0, sign = D, L = D + 1, size = L + D * D;
};
template <int D>
struct StressRecord {
  static constexpr int area = 0, T = 1, size = T + D * D;
};

template <int D, class W>
auto& gradient_records(W& w) {
  if constexpr (D == 2)
    return w.slim2;
  else
    return w.wide;
}
template <int D>
auto& stress_records(Work& w) {
  if constexpr (D == 2)
    return w.slim;
  else
    return w.wide2;
}

template <int D>
Matrix<D> matrix_at(const std::vector<double>& a, std::int64_t i) {
  Matrix<D> m;
  std::copy_n(a.begin() + i * D * D, D * D, m.begin());
  return m;
}

template <int D>
void write_pressure_records(Work& w, std::int64_t n) {
  using F = PressureRecord<D>;
  w.wide.resize(w.pairs.elements(n));
  parallel_for(n, [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    double* to = w.wide.at(k);
    to[F::area] = w.area[i];
    to[F::volume] = w.volume[i];
    to[F::eta] = w.viscosity[i];
    to[F::zeta] = w.bulk[i];
    for (int m = 0; m < D * D; ++m)
      to[F::P + m] = w.pressure[i] * w.volume[i] * w.correction[i * D * D + static_cast<std::size_t>(m)];
  });
  fill_images(w.pairs, n, w.wide, [&](std::size_t image, const double* from, double* to) {
    const auto &S = w.pairs.images.S[image], &R = w.pairs.images.R[image];
    std::copy_n(from, F::P, to);
    for (std::size_t a = 0; a < D; ++a)
      for (std::size_t b = 0; b < D; ++b) to[F::P + a * D + b] = S[a] * R[b] * from[F::P + a * D + b];
  });
  std::fill_n(w.wide.at(w.pairs.elements(n) - 1), 16, 0.0);
}

// Diagonal block of m - dt A without m and dt: residual pairs, the stress of the neighbours, and the own stress where
// neighbours are missing. Stored as upper triangle.
template <int D>
void store_block(Work& w, const Model& model, const Particles& p, std::size_t i, const Pack* pairs, double neighbours) {
  double g2 = 0;
  for (std::size_t a = 0; a < D; ++a) g2 += w.imbalance[a][i] * w.imbalance[a][i];
  const double own = 2 * w.viscosity[i] * w.volume[i], isotropic = (w.viscosity[i] / 3 + w.bulk[i]) * w.volume[i];
  double* block = w.preconditioner.data() + i * (D * (D + 1) / 2);
  for (std::size_t a = 0, m = 0; a < D; ++a)
    for (std::size_t b = a; b < D; ++b, ++m) {
      block[m] = lane_sum(pairs[m]) + isotropic * w.imbalance[a][i] * w.imbalance[b][i];
      if (a == b) block[m] += 0.5 * (neighbours + own * g2);
    }
  if (model.axisymmetric) {
    const double ir = inverse_radius(model, p.x[0][i]);
    block[0] += (0.5 * own + isotropic) * ir * ir;
  }
}

template <int D, class Mean>
void pressure_sweep(Work& w, const Particles& p, const Model& model, double coefficient) {
  using F = PressureRecord<D>;
  const double tiny = 1e-12 * model.h() * model.h();
  parallel_for(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    const double* self = w.wide.at(k);
    Pack force[D]{}, block[D * (D + 1) / 2]{}, around{};
    for_each_pack(w.pairs, k, [&](const std::int32_t* j, std::size_t q) {
      Pack other[F::size], r[D];
      gather(w.wide, j, other);
      Pack r2{};
      for (std::size_t d = 0; d < D; ++d) r[d] = w.r[d][q], r2 += r[d] * r[d];
      const Pack f = w.f[q], aj = other[F::area] * f, ai = self[F::area] * f;
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) force[a] += (aj * self[F::P + a * D + b] + ai * other[F::P + a * D + b]) * r[b];
      const Pack weight = coefficient * 0.5 * (self[F::area] * other[F::volume] + other[F::area] * self[F::volume]);
      const Pack kk = Mean::over(Pack(r2 + tiny), Pack(self[F::eta]), other[F::eta]) * weight * f;
      w.k[q] = kk;
      const Pack stress = other[F::volume] * ai * ai, isotropic = (other[F::eta] / 3 + other[F::zeta]) * stress;
      around += 2 * other[F::eta] * stress * r2;
      for (int a = 0, m = 0; a < D; ++a)
        for (int b = a; b < D; ++b, ++m) block[m] += (kk + isotropic) * r[a] * r[b];
    });
    for (std::size_t d = 0; d < D; ++d) w.acceleration[d][i] = model.gravity[d] + lane_sum(force[d]) / p.mass[i];
    if (model.axisymmetric)
      w.acceleration[0][i] += w.pressure[i] * w.volume[i] * inverse_radius(model, p.x[0][i]) / p.mass[i];
    store_block<D>(w, model, p, i, block, lane_sum(around));
  });
}

// First sweep: L = S B.
template <int D>
void gradient_sweep(Work& w, const Particles& p, const Model& model, const Field& v) {
  using F = GradientRecord<D>;
  auto& records = gradient_records<D>(w);
  const std::int64_t n = p.size();
  w.slim.resize(w.pairs.elements(n));
  records.resize(w.pairs.elements(n));
  parallel_for(n, [&](std::int64_t k) {
    double* to = w.slim.at(k);
    for (std::size_t d = 0; d < D; ++d) to[d] = v[d][static_cast<std::size_t>(k)];
    to[D] = w.area[static_cast<std::size_t>(k)];
  });
  fill_images(w.pairs, n, w.slim, [&](std::size_t image, const double* from, double* to) {
    for (std::size_t d = 0; d < D; ++d) to[d] = w.pairs.images.S[image][d] * from[d];
    to[D] = from[D];
  });
  std::fill_n(w.slim.at(w.pairs.elements(n) - 1), 8, 0.0);
  parallel_for(n, [&](std::int64_t k) {
    const double* self = w.slim.at(k);
    Pack S[D * D]{};
    for_each_pack(w.pairs, k, [&](const std::int32_t* j, std::size_t q) {
      Pack other[D + 1];
      gather(w.slim, j, other);
      const Pack af = other[D] * w.f[q];
      for (int a = 0; a < D; ++a) {
        const Pack dv = af * (self[a] - other[a]);
        for (std::size_t b = 0; b < D; ++b) S[a * D + static_cast<int>(b)] += dv * w.r[b][q];
      }
    });
    Matrix<D> s;
    for (std::size_t m = 0; m < s.size(); ++m) s[m] = lane_sum(S[m]);
    const Matrix<D> B = matrix_at<D>(w.correction, k);
    const Matrix<D> L = may_turn(w, p, model, static_cast<std::size_t>(k))
                            ? gradient<D>(s, matrix_at<D>(w.moment, k), B)
                            : product<D>(s, B);
    double* to = records.at(k);
    std::copy_n(self, D, to + F::v);
    to[F::sign] = 1;
    std::copy(L.begin(), L.end(), to + F::L);
  });
  fill_images(w.pairs, n, records, [&](std::size_t image, const double* from, double* to) {
    const auto &S = w.pairs.images.S[image], &R = w.pairs.images.R[image];
    for (std::size_t d = 0; d < D; ++d) to[F::v + d] = S[d] * from[F::v + d];
    to[F::sign] = R[0] * S[0] * from[F::sign];
    for (std::size_t a = 0; a < D; ++a)
      for (std::size_t b = 0; b < D; ++b) to[F::L + a * D + b] = S[a] * R[b] * from[F::L + a * D + b];
  });
  std::fill_n(records.at(w.pairs.elements(n) - 1), F::size, 0.0);
}

// Second sweep: T = V (2 eta e' + zeta tr L 1) - H, H = 1/2 sum P r of the residual pair forces P; leaves T B in the
// stress records, sum P and the hoop force in `force`.
template <int D>
void stress_sweep(Work& w, const Particles& p, const Model& model, const Field& v, Field& force) {
  using G = GradientRecord<D>;
  using F = StressRecord<D>;
  const auto& gradients = gradient_records<D>(w);
  auto& records = stress_records<D>(w);
  const std::int64_t n = p.size();
  records.resize(w.pairs.elements(n));
  parallel_for(n, [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    const double* self = gradients.at(k);
    Pack sum[D]{}, H[D * D]{};
    for_each_pack(w.pairs, k, [&](const std::int32_t* j, std::size_t q) {
      Pack other[G::size], r[D], missed{}, turned{};
      gather(gradients, j, other);
      for (std::size_t d = 0; d < D; ++d) r[d] = w.r[d][q];
      for (int a = 0; a < D; ++a) {
        Pack rest = self[G::v + a] - other[G::v + a];
        for (int b = 0; b < D; ++b) rest -= 0.5 * (self[G::L + a * D + b] + other[G::L + a * D + b]) * r[b];
        rest *= r[a];
        missed += rest;
        turned += a == D - 1 ? rest : rest * other[G::sign];
      }
      const Pack half_k = 0.5 * w.k[q];
      missed *= half_k;
      turned *= half_k;
      for (int a = 0; a < D; ++a) {
        const Pack P = r[a] * (a == D - 1 ? missed + turned : missed + turned * other[G::sign]);
        sum[a] += P;
        for (int b = 0; b < D; ++b) H[a * D + b] += P * r[b];
      }
    });
    Matrix<D> L;
    std::copy_n(self + G::L, D * D, L.begin());
    const double ir = model.axisymmetric ? inverse_radius(model, p.x[0][i]) : 0, hoop = v[0][i] * ir;
    double trace = hoop;
    for (int d = 0; d < D; ++d) trace += L[d * D + d];
    const double twice = 2 * w.viscosity[i] * w.volume[i], mean = w.bulk[i] * w.volume[i] * trace;
    trace /= 3;
    Matrix<D> T;
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b)
        T[a * D + b] = twice * (0.5 * (L[a * D + b] + L[b * D + a]) - (a == b ? trace : 0)) + (a == b ? mean : 0) -
                       0.5 * lane_sum(H[a * D + b]);
    const Matrix<D> B = matrix_at<D>(w.correction, k);
    const Matrix<D> TB =
        may_turn(w, p, model, i) ? gradient_adjoint<D>(T, matrix_at<D>(w.moment, k), B) : product<D>(T, B);
    for (std::size_t d = 0; d < D; ++d) force[d][i] = -lane_sum(sum[d]);
    force[0][i] -= (twice * (hoop - trace) + mean) * ir;
    double* to = records.at(k);
    to[F::area] = w.area[i];
    std::copy(TB.begin(), TB.end(), to + F::T);
  });
  fill_images(w.pairs, n, records, [&](std::size_t image, const double* from, double* to) {
    const auto &S = w.pairs.images.S[image], &R = w.pairs.images.R[image];
    to[F::area] = from[F::area];
    for (std::size_t a = 0; a < D; ++a)
      for (std::size_t b = 0; b < D; ++b) to[F::T + a * D + b] = S[a] * R[b] * from[F::T + a * D + b];
  });
  std::fill_n(records.at(w.pairs.elements(n) - 1), F::size, 0.0);
}

// sqrt(2 e:e) and Lode angle of the gradients the first sweep left in the records.
template <int D>
void read_shear_rate(Work& w, const Particles& p, const Model& model, const Field& v) {
  const auto& records = gradient_records<D>(w);
  parallel_for(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    Matrix<D> L;
    std::copy_n(records.at(k) + GradientRecord<D>::L, D * D, L.begin());
    const double hoop = model.axisymmetric ? v[0][i] * inverse_radius(model, p.x[0][i]) : 0;
    w.shear_rate[i] = shear_rate<D>(L, hoop);
    if (!w.lode.empty()) w.lode[i] = lode_parameter<D>(L, hoop);
  });
}

template <int D>
LawDissipation sum_dissipation(const Work& w, const Particles& p, const Model& model, const Field& v) {
  const auto& records = gradient_records<D>(w);
  return parallel_sum<LawDissipation>(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    Matrix<D> L;
    std::copy_n(records.at(k) + GradientRecord<D>::L, D * D, L.begin());
    const double hoop = model.axisymmetric ? v[0][i] * inverse_radius(model, p.x[0][i]) : 0,
                 rate = shear_rate<D>(L, hoop);
    double trace = hoop;
    for (int d = 0; d < D; ++d) trace += L[d * D + d];
    return LawDissipation{w.viscosity[i] * w.volume[i] * (rate * rate - 2 * trace * trace / 3),
                          w.bulk[i] * w.volume[i] * trace * trace};
  });
}

// Third sweep: force of the stresses of both particles.
template <int D>
void force_sweep(Work& w, const Particles& p, Field& force) {
  using F = StressRecord<D>;
  const auto& records = stress_records<D>(w);
  parallel_for(p.size(), [&](std::int64_t k) {
    const double* self = records.at(k);
    Pack sum[D]{};
    for_each_pack(w.pairs, k, [&](const std::int32_t* j, std::size_t q) {
      Pack other[F::size];
      gather(records, j, other);
      const Pack f = w.f[q], aj = other[F::area] * f, ai = self[F::area] * f;
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b)
          sum[a] += (aj * self[F::T + a * D + b] + ai * other[F::T + a * D + b]) * w.r[static_cast<std::size_t>(b)][q];
    });
    for (std::size_t d = 0; d < D; ++d) force[d][static_cast<std::size_t>(k)] -= lane_sum(sum[d]);
  });
}

template <int D>
void viscous_sweeps(Work& w, const Particles& p, const Model& model, const Field& v, Field& force) {
  gradient_sweep<D>(w, p, model, v);
  stress_sweep<D>(w, p, model, v, force);
  force_sweep<D>(w, p, force);
}

}  // namespace

void corrected_pressure_and_coefficients(Work& w, const Particles& p, const Model& model) {
  w.k.resize(w.pairs.index.size() / Pack::lanes);
  const double coefficient = std::visit([&](const auto& v) { return v.coefficient(model.dim); }, model.viscous);
  std::visit(
      [&](const auto& mean) {
        using Mean = std::decay_t<decltype(mean)>;
        if (model.dim == 2)
          write_pressure_records<2>(w, p.size()), pressure_sweep<2, Mean>(w, p, model, coefficient);
        else
          write_pressure_records<3>(w, p.size()), pressure_sweep<3, Mean>(w, p, model, coefficient);
      },
      model.mean);
}

void corrected_shear_rate(Work& w, const Particles& p, const Model& model, const Field& v) {
  if (model.dim == 2)
    gradient_sweep<2>(w, p, model, v), read_shear_rate<2>(w, p, model, v);
  else
    gradient_sweep<3>(w, p, model, v), read_shear_rate<3>(w, p, model, v);
}

LawDissipation corrected_dissipation(const Work& w, const Particles& p, const Model& model, const Field& v) {
  return model.dim == 2 ? sum_dissipation<2>(w, p, model, v) : sum_dissipation<3>(w, p, model, v);
}

void corrected_viscous_force(Work& w, const Particles& p, const Model& model, const Field& v, Field& force) {
  if (model.dim == 2)
    viscous_sweeps<2>(w, p, model, v, force);
  else
    viscous_sweeps<3>(w, p, model, v, force);
}

}  // namespace bagnold::sph

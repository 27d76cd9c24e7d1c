// Pressure and viscosity as central pair forces                                 Minatti & Paris 2015, eqs 27, 37, 38
#include <algorithm>

#include "core/parallel.hpp"
#include "sph/dispatch.hpp"
#include "sph/forces.hpp"
#include "sph/ghosts.hpp"
#include "sph/pair_record.hpp"

namespace bagnold::sph {
namespace {

// Kinematics has written the rest, at the same positions.
template <int D>
void write_stresses(Work& w, const Particles& p) {
  using F = PairRecord<D>;
  auto& records = pair_records<D>(w);
  parallel_for(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    const double inv_rho = 1 / p.rho[i];
    double* to = records.at(k);
    to[F::inv_rho] = inv_rho;
    to[F::P] = w.pressure[i] * inv_rho * inv_rho;
    to[F::eta] = w.viscosity[i];
  });
  fill_images(w.pairs, p.size(), records, [](std::size_t, const double* from, double* to) {
    std::copy(from + F::inv_rho, from + F::size, to + F::inv_rho);
  });
  double* dummy = records.at(w.pairs.elements(p.size()) - 1);
  dummy[F::inv_rho] = dummy[F::P] = dummy[F::eta] = 0;
}

// P_i + P_j + Pi_ij - coefficient eta_ij (v_ij . r_ij)/(r_ij^2 rho_i rho_j); times m_j f r_ij it is the acceleration of i.
// `vr` is v_ij . r_ij; a, b are the records of the two particles.
template <int D, class Mean, bool viscous, bool artificial, class T>
T strength(const T& r2, const T& vr, const double* a, const T* b, double coefficient, double alpha_h_c) {
  using F = PairRecord<D>;
  T s = a[F::P] + b[F::P];
  if constexpr (viscous)
    s -= (coefficient * a[F::inv_rho]) * b[F::inv_rho] * vr * Mean::over(r2, T(a[F::eta]), b[F::eta]);
  if constexpr (artificial)
    s -= alpha_h_c * 2 * a[F::inv_rho] * b[F::inv_rho] * vr / (r2 * (a[F::inv_rho] + b[F::inv_rho]));
  return s;
}

// Sums over the neighbours of particles begin to end, without the constants of the kernel.
template <int D, class Kernel, class Mean, bool viscous, bool artificial>
void sum_rates(Work& w, const PairShape<D, Kernel> shape, double coefficient, double alpha_h_c, std::int64_t begin,
               std::int64_t end, double* sums) {
  using F = PairRecord<D>;
  const auto& records = pair_records<D>(w);
  Pack all[pair_block * D];
  for (std::int64_t i = begin; i < end; ++i) {
    const double* self = records.at(i);
    Pack sum[D]{};
    for_each_pack(w.pairs, i, [&](const std::int32_t* j, std::size_t) {
      Pack other[F::size], r[D], r2 = shape.tiny, vr{};
      gather(records, j, other);
      for (int d = 0; d < D; ++d) {
        r[d] = self[F::x + d] - other[F::x + d];
        r2 += r[d] * r[d];
        vr += (self[F::v + d] - other[F::v + d]) * r[d];
      }
      const Pack mf = shape.unscaled_f(other[F::mass], shape.ratio(r2)),
                 s = mf * strength<D, Mean, viscous, artificial>(r2, vr, self, other, coefficient, alpha_h_c);
      for (int d = 0; d < D; ++d) sum[d] += s * r[d];
    });
    for (int d = 0; d < D; ++d) all[(i - begin) * D + d] = sum[d];
  }
  lane_sums(all, static_cast<int>(end - begin) * D, sums);
}

template <int D, class Kernel, class Mean, bool viscous, bool artificial>
void rate_sweep(Work& w, const Particles& p, const Model& model) {
  using F = PairRecord<D>;
  const PairShape<D, Kernel> shape(model.h());
  const double coefficient = laws::viscous::Cleary::coefficient(D),
               alpha_h_c = model.numerics.artificial_viscosity * model.h() * model.sound_speed();
  parallel_blocks(p.size(), pair_block, [&](std::int64_t begin, std::int64_t end) {
    std::array<double, pair_block * D> sums;
    sum_rates<D, Kernel, Mean, viscous, artificial>(w, shape, coefficient, alpha_h_c, begin, end, sums.data());
    for (std::int64_t k = begin; k < end; ++k) {
      const auto i = static_cast<std::size_t>(k);
      double* a = sums.data() + (k - begin) * D;
      for (int d = 0; d < D; ++d) a[d] *= shape.slope_scale;
      const double* self = pair_records<D>(w).at(k);
      std::array<double, D> x, v;
      for (std::size_t d = 0; d < D; ++d) x[d] = self[F::x + d], v[d] = self[F::v + d];
      if (model.floor && x[D - 1] < 2 * model.h())
        for_each_ghost<D>(model, x, [&](const std::array<double, D>& r, double beta) {
          double r2 = shape.tiny, vr = 0;
          for (std::size_t d = 0; d < D; ++d) r2 += r[d] * r[d], vr += beta * v[d] * r[d];
          const double mf = self[F::mass] * shape.f(shape.ratio(r2));
          const double s = mf * strength<D, Mean, viscous, artificial>(r2, vr, self, self, coefficient, alpha_h_c);
          for (std::size_t d = 0; d < D; ++d) a[d] += s * r[d];
        });
      for (std::size_t d = 0; d < D; ++d) w.acceleration[d][i] = model.gravity[d] + a[d];
    }
  });
}

// Adds s r r to the upper triangle `block`.
template <int D, class T>
void add_block(T* block, const T& s, const T* r) {
  for (int a = 0, m = 0; a < D; ++a)
    for (int b = a; b < D; ++b, ++m) block[m] += s * r[a] * r[b];
}

template <int D, class Kernel, class Mean>
void coefficient_sweep(Work& w, const Particles& p, const Model& model) {
  using F = PairRecord<D>;
  const PairShape<D, Kernel> shape(model.h());
  const auto& records = pair_records<D>(w);
  const double coefficient = laws::viscous::Cleary::coefficient(D);
  parallel_for(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    const double* self = records.at(k);
    Pack block[D * (D + 1) / 2]{};
    for_each_pack(w.pairs, k, [&](const std::int32_t* j, std::size_t q) {
      Pack other[F::size], r[D], r2 = shape.tiny;
      gather(records, j, other);
      for (int d = 0; d < D; ++d) r[d] = self[F::x + d] - other[F::x + d], r2 += r[d] * r[d];
      const Pack volume = other[F::mass] * other[F::inv_rho] * w.volume[i];
      const Pack kk =
          coefficient * Mean::over(r2, Pack(self[F::eta]), other[F::eta]) * volume * shape.f(shape.ratio(r2));
      w.k[q] = kk;
      for (std::size_t d = 0; d < D; ++d) w.r[d][q] = r[d];
      add_block<D>(block, kk, r);
    });
    // The ghosts resist the particle alone: a fixed matrix, kept in `wall`.
    double* wall = w.wall.data() + i * (D * (D + 1) / 2);
    std::fill_n(wall, D * (D + 1) / 2, 0.0);
    if (model.floor && p.x[D - 1][i] < 2 * model.h()) {
      std::array<double, D> x;
      for (std::size_t d = 0; d < D; ++d) x[d] = p.x[d][i];
      for_each_ghost<D>(model, x, [&](const std::array<double, D>& r, double beta) {
        double r2 = shape.tiny;
        for (const double c : r) r2 += c * c;
        add_block<D>(wall,
                     coefficient * w.viscosity[i] * w.volume[i] * w.volume[i] * shape.f(shape.ratio(r2)) / r2 * beta,
                     r.data());
      });
    }
    for (std::size_t m = 0; m < D * (D + 1) / 2; ++m)
      w.preconditioner[i * (D * (D + 1) / 2) + m] = lane_sum(block[m]) + wall[m];
  });
}

template <int D>
void viscous_sweep(Work& w, const Particles& p, const Field& v, Field& force) {
  const std::int64_t n = p.size();
  w.slim.resize(w.pairs.elements(n));
  parallel_for(n, [&](std::int64_t k) {
    for (std::size_t d = 0; d < D; ++d) w.slim.at(k)[d] = v[d][static_cast<std::size_t>(k)];
  });
  fill_images(w.pairs, n, w.slim, [&](std::size_t image, const double* from, double* to) {
    for (std::size_t d = 0; d < D; ++d) to[d] = w.pairs.images.S[image][d] * from[d];
  });
  std::fill_n(w.slim.at(w.pairs.elements(n) - 1), 8, 0.0);
  parallel_for(n, [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    Pack sum[D]{};
    for_each_pack(w.pairs, k, [&](const std::int32_t* j, std::size_t q) {
      Pack other[D], vr{};
      gather(w.slim, j, other);
      for (std::size_t d = 0; d < D; ++d) vr += (w.slim.at(k)[d] - other[d]) * w.r[d][q];
      for (std::size_t d = 0; d < D; ++d) sum[d] += w.k[q] * vr * w.r[d][q];
    });
    const double* wall = w.wall.data() + i * (D * (D + 1) / 2);
    std::array<double, D> drag{};
    for (std::size_t a = 0, m = 0; a < D; ++a)
      for (std::size_t b = a; b < D; ++b, ++m) {
        drag[a] += wall[m] * v[b][i];
        if (a != b) drag[b] += wall[m] * v[a][i];
      }
    for (std::size_t d = 0; d < D; ++d) force[d][i] = -lane_sum(sum[d]) - drag[d];
  });
}

}  // namespace

void pair_momentum_rate(Work& w, const Particles& p, const Model& model, bool viscous) {
  const bool artificial = model.numerics.artificial_viscosity > 0;
  dispatch(model, [&](auto dim, const auto& kernel) {
    constexpr int D = decltype(dim)::value;
    using Kernel = std::decay_t<decltype(kernel)>;
    write_stresses<D>(w, p);
    std::visit(
        [&](const auto& mean) {
          using Mean = std::decay_t<decltype(mean)>;
          if (!viscous)
            rate_sweep<D, Kernel, Mean, false, false>(w, p, model);
          else if (artificial)
            rate_sweep<D, Kernel, Mean, true, true>(w, p, model);
          else
            rate_sweep<D, Kernel, Mean, true, false>(w, p, model);
        },
        model.mean);
  });
}

void pair_coefficients(Work& w, const Particles& p, const Model& model) {
  w.k.resize(w.pairs.index.size() / Pack::lanes);
  for (std::size_t d = 0; d < static_cast<std::size_t>(model.dim); ++d)
    w.r[d].resize(w.pairs.index.size() / Pack::lanes);
  dispatch(model, [&](auto dim, const auto& kernel) {
    constexpr int D = decltype(dim)::value;
    write_stresses<D>(w, p);
    std::visit(
        [&](const auto& mean) {
          coefficient_sweep<D, std::decay_t<decltype(kernel)>, std::decay_t<decltype(mean)>>(w, p, model);
        },
        model.mean);
  });
}

void pair_viscous_force(Work& w, const Particles& p, const Model& model, const Field& v, Field& force) {
  if (model.dim == 2)
    viscous_sweep<2>(w, p, v, force);
  else
    viscous_sweep<3>(w, p, v, force);
}

}  // namespace bagnold::sph

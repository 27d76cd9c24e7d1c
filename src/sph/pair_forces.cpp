// Pressure and viscosity as central pair forces                                 Minatti & Paris 2015, eqs 27, 37, 38
#include <algorithm>

#include "core/parallel.hpp"
#include "sph/dispatch.hpp"
#include "sph/forces.hpp"
#include "sph/ghosts.hpp"

namespace bagnold::sph {
namespace {

template <int D>
struct PairRecord {
  static constexpr int x = 0, v = D, mass = 2 * D, P = mass + 1, eta = mass + 2, inv_rho = mass + 3,
                       size = mass + 4;  // P = p/rho^2
};

template <int D>
auto& pair_records(Work& w) {
  if constexpr (D == 2)
    return w.slim;
  else
    return w.wide;
}

template <int D>
void write_pair_records(Work& w, const Particles& p, const Model&) {
  using F = PairRecord<D>;
  auto& records = pair_records<D>(w);
  const std::int64_t n = p.size();
  records.resize(w.pairs.elements(n));
  parallel_for(n, [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    double* to = records.at(k);
    for (std::size_t d = 0; d < D; ++d) to[F::x + d] = p.x[d][i], to[F::v + d] = p.v[d][i];
    const double inv_rho = 1 / p.rho[i];
    to[F::mass] = p.mass[i];
    to[F::P] = w.pressure[i] * inv_rho * inv_rho;
    to[F::eta] = w.viscosity[i];
    to[F::inv_rho] = inv_rho;
  });
  fill_images(w.pairs, n, records, [&](std::size_t image, const double* from, double* to) {
    const Images& m = w.pairs.images;
    for (std::size_t d = 0; d < D; ++d) {
      to[F::x + d] = m.R[image][d] * from[F::x + d] + m.shift[image][d];
      to[F::v + d] = m.S[image][d] * from[F::v + d];
    }
    std::copy(from + F::mass, from + F::size, to + F::mass);
  });
  double* dummy = records.at(w.pairs.elements(n) - 1);
  for (int d = 0; d < D; ++d) dummy[F::x + d] = 1e30, dummy[F::v + d] = 0;
  std::fill(dummy + F::mass, dummy + F::size, 0.0);
}

// m_j f (P_i + P_j + Pi_ij - coefficient eta_ij (v_ij . r_ij)/(r_ij^2 rho_i rho_j)): acceleration of i over r_ij.
template <class Mean, bool viscous, bool artificial, class T>
T strength(const T& f, const T& vr, const T& r2, const double* a, const T* b, double coefficient, double alpha_h_c) {
  // a, b: mass, P, eta, 1/rho of the two particles
  T s = a[1] + b[1];
  if constexpr (viscous) {
    T drag = coefficient * Mean::of(constant<T>(a[2]), b[2]) * (a[3] * b[3]);
    if constexpr (artificial) drag += alpha_h_c * 2 * a[3] * b[3] / (a[3] + b[3]);
    s -= drag * vr / r2;
  }
  return b[0] * f * s;
}

template <int D, class Kernel, class Mean, bool viscous, bool artificial>
void rate_sweep(Work& w, const Particles& p, const Model& model) {
  using F = PairRecord<D>;
  const PairShape<D, Kernel> shape(model.h());
  const auto& records = pair_records<D>(w);
  const double tiny = 1e-12 * model.h() * model.h(), coefficient = laws::viscous::Cleary::coefficient(D),
               alpha_h_c = model.numerics.artificial_viscosity * model.h() * model.sound_speed();
  parallel_for(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    const double* self = records.at(k);
    Octet sum[D]{};
    for_each_octet(w.pairs, k, [&](const std::int32_t* j, std::size_t) {
      Octet other[F::size], r[D], r2 = splat(tiny), vr{};
      gather(records, j, other);
      for (int d = 0; d < D; ++d) {
        r[d] = self[F::x + d] - other[F::x + d];
        r2 += r[d] * r[d];
        vr += (self[F::v + d] - other[F::v + d]) * r[d];
      }
      const Octet s = strength<Mean, viscous, artificial>(shape.f(shape.ratio(r2)), vr, r2, self + F::mass,
                                                          other + F::mass, coefficient, alpha_h_c);
      for (int d = 0; d < D; ++d) sum[d] += s * r[d];
    });
    std::array<double, D> a;
    for (std::size_t d = 0; d < D; ++d) a[d] = model.gravity[d] + lane_sum(sum[d]);
    if (model.floor && p.x[D - 1][i] < 2 * model.h()) {
      std::array<double, D> x;
      for (std::size_t d = 0; d < D; ++d) x[d] = p.x[d][i];
      for_each_ghost<D>(model, x, [&](const std::array<double, D>& r, double beta) {
        double r2 = tiny, vr = 0;
        for (std::size_t d = 0; d < D; ++d) r2 += r[d] * r[d], vr += beta * p.v[d][i] * r[d];
        const double s = strength<Mean, viscous, artificial>(shape.f(shape.ratio(r2)), vr, r2, self + F::mass,
                                                             self + F::mass, coefficient, alpha_h_c);
        for (std::size_t d = 0; d < D; ++d) a[d] += s * r[d];
      });
    }
    for (std::size_t d = 0; d < D; ++d) w.acceleration[d][i] = a[d];
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
  const double tiny = 1e-12 * model.h() * model.h(), coefficient = laws::viscous::Cleary::coefficient(D);
  parallel_for(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    const double* self = records.at(k);
    Octet block[D * (D + 1) / 2]{};
    for_each_octet(w.pairs, k, [&](const std::int32_t* j, std::size_t q) {
      Octet other[F::size], r[D], r2 = splat(tiny);
      gather(records, j, other);
      for (int d = 0; d < D; ++d) r[d] = self[F::x + d] - other[F::x + d], r2 += r[d] * r[d];
      const Octet volume = other[F::mass] * other[F::inv_rho] * w.volume[i];
      const Octet kk =
          coefficient * Mean::of(splat(self[F::eta]), other[F::eta]) * volume * shape.f(shape.ratio(r2)) / r2;
      w.k[q] = kk;
      for (std::size_t d = 0; d < D; ++d) w.r[d][q] = r[d];
      add_block<D>(block, kk, r);
    });
    // The ghosts resist the particle alone: a fixed matrix, kept in `quartic`.
    double* wall = w.quartic.data() + i * (D == 2 ? 5 : 15);
    std::fill_n(wall, D * (D + 1) / 2, 0.0);
    if (model.floor && p.x[D - 1][i] < 2 * model.h()) {
      std::array<double, D> x;
      for (std::size_t d = 0; d < D; ++d) x[d] = p.x[d][i];
      for_each_ghost<D>(model, x, [&](const std::array<double, D>& r, double beta) {
        double r2 = tiny;
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
    Octet sum[D]{};
    for_each_octet(w.pairs, k, [&](const std::int32_t* j, std::size_t q) {
      Octet other[D], vr{};
      gather(w.slim, j, other);
      for (std::size_t d = 0; d < D; ++d) vr += (w.slim.at(k)[d] - other[d]) * w.r[d][q];
      for (std::size_t d = 0; d < D; ++d) sum[d] += w.k[q] * vr * w.r[d][q];
    });
    const double* wall = w.quartic.data() + i * (D == 2 ? 5 : 15);
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
    write_pair_records<D>(w, p, model);
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
  w.k.resize(w.pairs.index.size() / octet_size);
  for (std::size_t d = 0; d < static_cast<std::size_t>(model.dim); ++d)
    w.r[d].resize(w.pairs.index.size() / octet_size);
  dispatch(model, [&](auto dim, const auto& kernel) {
    constexpr int D = decltype(dim)::value;
    write_pair_records<D>(w, p, model);
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

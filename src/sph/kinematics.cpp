#include "sph/kinematics.hpp"

#include "core/parallel.hpp"
#include "sph/dispatch.hpp"
#include "sph/ghosts.hpp"
#include "sph/pair_record.hpp"
#include "sph/small_tensor.hpp"

namespace bagnold::sph {
namespace {

constexpr double blend_from = 0.3;  // of B = M^-1 to 1, up to blend_to

// Where the sums over the neighbours of one particle lie.
template <int D, Kinematics what, bool moments>
struct Slots {
  static constexpr bool printed = what != Kinematics::corrected, gradients = what != Kinematics::density;
  static constexpr int triangle = D * (D + 1) / 2;
  static constexpr int density = 0;         // sum m_j f (v_ij . r_ij), printed only
  static constexpr int gradient = printed;  // printed: S + S^T with its diagonal halved, upper triangle; else S
  static constexpr int M = gradient + (!gradients ? 0 : printed ? triangle : D * D);  // sum A_j f r r, upper triangle
  static constexpr int imbalance = M + triangle, concentration = imbalance + D;
  static constexpr int size = moments ? concentration + 1 : M;
};

template <int D>
void write_records(Work& w, const Particles& p, bool corrected) {
  using F = PairRecord<D>;
  auto& records = pair_records<D>(w);
  const std::int64_t n = p.size();
  records.resize(w.pairs.elements(n));
  parallel_for(n, [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    double* to = records.at(k);
    for (std::size_t d = 0; d < D; ++d) to[F::x + d] = p.x[d][i], to[F::v + d] = p.v[d][i];
    to[F::mass] = corrected ? w.area[i] : p.mass[i];
    to[F::inv_rho] = 1 / p.rho[i];
  });
  fill_images(w.pairs, n, records, [&](std::size_t image, const double* from, double* to) {
    const Images& m = w.pairs.images;
    for (std::size_t d = 0; d < D; ++d) {
      to[F::x + d] = m.R[image][d] * from[F::x + d] + m.shift[image][d];
      to[F::v + d] = m.S[image][d] * from[F::v + d];
    }
    to[F::mass] = from[F::mass];
    to[F::inv_rho] = from[F::inv_rho];
  });
  double* dummy = records.at(w.pairs.elements(n) - 1);
  for (int d = 0; d < D; ++d) dummy[F::x + d] = 1e30, dummy[F::v + d] = 0;
  dummy[F::mass] = dummy[F::inv_rho] = 0;
}

// a += w b c^T; the upper triangle of a += w b b^T.
template <int D>
void add_product(Pack* a, const Pack& w, const Pack (&b)[D], const Pack (&c)[D]) {
  for (int i = 0; i < D; ++i) {
    const Pack wb = w * b[i];
    for (int j = 0; j < D; ++j) a[i * D + j] += wb * c[j];
  }
}
template <int D>
void add_square(Pack* a, const Pack& w, const Pack (&b)[D]) {
  for (int i = 0, m = 0; i < D; ++i) {
    const Pack wb = w * b[i];
    for (int j = i; j < D; ++j, ++m) a[m] += wb * b[j];
  }
}

// The sums of particles begin to end, those of the printed equations without the constants of the kernel.
template <int D, class Kernel, Kinematics what, bool moments>
void sum_neighbours(Work& w, const PairShape<D, Kernel> shape, std::int64_t begin, std::int64_t end, double* sums) {
  using F = PairRecord<D>;
  using At = Slots<D, what, moments>;
  const auto& records = pair_records<D>(w);
  Pack all[pair_block * At::size];
  for (std::int64_t i = begin; i < end; ++i) {
    const double* self = records.at(i);
    Pack sum[At::size]{};
    for_each_pack(w.pairs, i, [&](const std::int32_t* j, std::size_t q) {
      Pack other[F::inv_rho + 1], r[D], v[D], r2 = shape.tiny, vr{};
      gather(records, j, other);
      for (int d = 0; d < D; ++d) {
        r[d] = self[F::x + d] - other[F::x + d];
        v[d] = self[F::v + d] - other[F::v + d];
        r2 += r[d] * r[d];
        vr += v[d] * r[d];
      }
      const Pack R = shape.ratio(r2);
      if constexpr (!At::gradients) {
        sum[At::density] += shape.unscaled_f(other[F::mass] * vr, R);
        return;
      }
      Pack af;
      if constexpr (At::printed) {  // the kernel last: all else is ready before it
        const Pack mf = shape.unscaled_f(other[F::mass], R);
        af = mf * other[F::inv_rho];
        sum[At::density] += mf * vr;
        for (int d = 0; d < D; ++d) v[d] *= af;
        for (int a = 0, m = At::gradient; a < D; ++a)
          for (int b = a; b < D; ++b, ++m) {
            sum[m] += v[a] * r[b];
            if (a != b) sum[m] += v[b] * r[a];
          }
      } else {
        const Pack f = shape.f(R);
        af = other[F::mass] * f;
        add_product<D>(sum + At::gradient, af, v, r);
        for (std::size_t d = 0; d < D; ++d) w.r[d][q] = r[d];
        w.f[q] = f;
      }
      if constexpr (moments) {
        add_square<D>(sum + At::M, af, r);
        for (int d = 0; d < D; ++d) sum[At::imbalance + d] += af * r[d];
        const Pack area = At::printed ? other[F::mass] * other[F::inv_rho] : other[F::mass];
        sum[At::concentration] += area * shape.w(R);
      }
    });
    for (int m = 0; m < At::size; ++m) all[(i - begin) * At::size + m] = sum[m];
  }
  lane_sums(all, static_cast<int>(end - begin) * At::size, sums);
}

template <int D, class Kernel, Kinematics what, bool moments>
void add_ghosts(double* sums, const PairShape<D, Kernel>& shape, const Model& model, const double* self) {
  using F = PairRecord<D>;
  using At = Slots<D, what, moments>;
  std::array<double, D> x, v;
  for (std::size_t d = 0; d < D; ++d) x[d] = self[F::x + d], v[d] = self[F::v + d];
  const double mass = self[F::mass], area = mass * self[F::inv_rho];
  for_each_ghost<D>(model, x, [&](const std::array<double, D>& r, double beta) {
    double r2 = shape.tiny, vr = 0;
    for (std::size_t d = 0; d < D; ++d) r2 += r[d] * r[d], vr += beta * v[d] * r[d];
    const double R = shape.ratio(r2), f = shape.f(R);
    sums[At::density] += mass * f * vr;
    for (std::size_t a = 0, m = 0; a < D; ++a) {
      if constexpr (moments) sums[At::imbalance + static_cast<int>(a)] += area * f * r[a];
      for (std::size_t b = a; b < D; ++b, ++m) {
        if constexpr (At::gradients)
          sums[At::gradient + static_cast<int>(m)] +=
              area * f * beta * (a == b ? v[a] * r[a] : v[a] * r[b] + v[b] * r[a]);
        if constexpr (moments) sums[At::M + static_cast<int>(m)] += area * f * r[a] * r[b];
      }
    }
    if constexpr (moments) sums[At::concentration] += area * shape.w(R);
  });
}

// sqrt(2 e:e) from S + S^T with its diagonal halved.
template <int D>
double shear_rate_of_sum(const double* E) {
  double sum = 0;
  for (int a = 0, m = 0; a < D; ++a)
    for (int b = a; b < D; ++b, ++m) sum += (a == b ? 2 : 1) * E[m] * E[m];
  return std::sqrt(sum);
}

template <int D>
double lode_parameter_of_sum(const double* E) {
  Matrix<D> e = from_upper<D>(E);
  for (int k = 0; k < D * D; ++k) e[k] *= k % (D + 1) == 0 ? 1 : 0.5;
  return lode_parameter<D>(e, 0);
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

// What follows from the sums of particle i.
template <int D, Kinematics what, bool moments>
void store(Work& w, const Particles& p, const Model& model, std::size_t i, const double* sums) {
  using At = Slots<D, what, moments>;
  if constexpr (At::printed) w.density_rate[i] = -sums[At::density];
  const double hoop = model.axisymmetric ? p.v[0][i] * inverse_radius(model, p.x[0][i]) : 0;
  if constexpr (moments) {
    const Matrix<D> M = from_upper<D>(sums + At::M);
    w.coverage[i] = smallest_eigenvalue(M);
    w.concentration[i] = sums[At::concentration];
    for (std::size_t d = 0; d < D; ++d) w.imbalance[d][i] = sums[At::imbalance + static_cast<int>(d)];
    const Matrix<D> B = correction<D>(M, w.coverage[i]);
    std::copy(M.begin(), M.end(), w.moment.begin() + static_cast<std::ptrdiff_t>(i * D * D));
    std::copy(B.begin(), B.end(), w.correction.begin() + static_cast<std::ptrdiff_t>(i * D * D));
    if constexpr (!At::printed) {
      Matrix<D> S;
      std::copy_n(sums + At::gradient, D * D, S.begin());
      const Matrix<D> L = may_turn(w, p, model, i) ? gradient<D>(S, M, B) : product<D>(S, B);
      double divergence = hoop;
      for (int d = 0; d < D; ++d) divergence += L[d * D + d];
      w.density_rate[i] = -p.rho[i] * divergence;
      std::copy(L.begin(), L.end(), w.gradient.begin() + static_cast<std::ptrdiff_t>(i * D * D));
      w.shear_rate[i] = shear_rate<D>(L, hoop);
      if (!w.lode.empty()) w.lode[i] = lode_parameter<D>(L, hoop);
    }
  }
  if constexpr (At::printed && At::gradients) {
    w.shear_rate[i] = shear_rate_of_sum<D>(sums + At::gradient);
    if (!w.lode.empty()) w.lode[i] = lode_parameter_of_sum<D>(sums + At::gradient);
  }
}

template <int D, class Kernel, Kinematics what, bool moments>
void sweep(Work& w, const Particles& p, const Model& model) {
  using At = Slots<D, what, moments>;
  const PairShape<D, Kernel> shape(model.h());
  const bool ghosts = model.floor && !model.corrected();
  parallel_blocks(p.size(), pair_block, [&](std::int64_t begin, std::int64_t end) {
    std::array<double, pair_block * At::size> all;
    sum_neighbours<D, Kernel, what, moments>(w, shape, begin, end, all.data());
    for (std::int64_t k = begin; k < end; ++k) {
      const auto i = static_cast<std::size_t>(k);
      double* sums = all.data() + (k - begin) * At::size;
      if constexpr (At::printed) {
        constexpr int scaled = moments ? At::concentration : At::size;
        for (int m = 0; m < scaled; ++m) sums[m] *= shape.slope_scale;
        if (ghosts && p.x[D - 1][i] < 2 * model.h())
          add_ghosts<D, Kernel, what, moments>(sums, shape, model, pair_records<D>(w).at(k));
      }
      if constexpr (moments) sums[At::concentration] += w.area[i] * shape.w(0.0);
      store<D, what, moments>(w, p, model, i, sums);
    }
  });
}

}  // namespace

void update_volumes(Work& w, const Particles& p) {
  parallel_for(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    w.volume[i] = p.mass[i] / p.rho[i];
  });
}

void kinematics(Work& w, const Particles& p, const Model& model, Kinematics what, bool moments) {
  if (what == Kinematics::corrected || moments) {
    update_volumes(w, p);
    parallel_for(p.size(), [&](std::int64_t k) {
      const auto i = static_cast<std::size_t>(k);
      w.area[i] = model.axisymmetric ? w.volume[i] * inverse_radius(model, p.x[0][i]) / (2 * M_PI) : w.volume[i];
    });
  }
  if (model.lode_angles()) w.lode.resize(w.shear_rate.size());
  if (what == Kinematics::corrected) {
    for (std::size_t d = 0; d < static_cast<std::size_t>(model.dim); ++d)
      w.r[d].resize(w.pairs.index.size() / Pack::lanes);
    w.f.resize(w.pairs.index.size() / Pack::lanes);
  }
  dispatch(model, [&](auto dim, const auto& kernel) {
    constexpr int D = decltype(dim)::value;
    using Kernel = std::decay_t<decltype(kernel)>;
    write_records<D>(w, p, what == Kinematics::corrected);
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

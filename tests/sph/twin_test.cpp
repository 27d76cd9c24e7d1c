// Slow plain twins of the discrete operators and of the neighbour lists.
#include "operators.hpp"
#include "sph/small_tensor.hpp"

namespace bagnold::sph::test {
namespace {

// The dissipation potential of a free block as docs/sph.md writes it, by plain sums over all pairs.
template <int D>
double potential(const Case& c, const Field& v, bool law_only = false) {
  const Particles& p = c.state.particles;
  const std::size_t n = p.mass.size();
  const double h = c.model.h(), a = (D == 2 ? 7 / (64 * M_PI) : 21 / (256 * M_PI)) / std::pow(h, D);
  const auto geometry = [&](std::size_t i, std::size_t j, std::array<double, D>& r) {
    double r2 = 0;
    for (std::size_t d = 0; d < D; ++d) r[d] = p.x[d][i] - p.x[d][j], r2 += r[d] * r[d];
    return 10 * a * std::pow(std::max(0.0, 2 - std::sqrt(r2) / h), 3) / (h * h);
  };
  double sum = 0;
  std::array<double, D> r;
  std::vector<Matrix<D>> gradients;
  for (std::size_t i = 0; i < n; ++i) {
    Matrix<D> M{}, S{};
    for (std::size_t j = 0; j < n; ++j) {
      if (i == j) continue;
      const double Vf = p.mass[j] / p.rho[j] * geometry(i, j, r);
      for (std::size_t k = 0; k < D; ++k)
        for (std::size_t l = 0; l < D; ++l) {
          M[k * D + l] += Vf * r[k] * r[l];
          S[k * D + l] += Vf * (v[k][i] - v[k][j]) * r[l];
        }
    }
    const double weight = std::clamp((smallest_eigenvalue(M) - 0.3) / 0.2, 0.0, 1.0);
    Matrix<D> B = inverse(M);
    for (std::size_t k = 0; k < D * D; ++k) B[k] = weight * B[k] + (k % (D + 1) == 0 ? 1 - weight : 0);
    // L = S B + G (1 - M B), G the rotation that fits best: moment of velocities = inertia times rate
    Matrix<D> G{}, lacking = product<D>(M, B);
    for (std::size_t k = 0; k < D * D; ++k) lacking[k] = (k % (D + 1) == 0 ? 1 : 0) - lacking[k];
    if constexpr (D == 2) {
      G[2] = (S[2] - S[1]) / (M[0] + M[3]);
      G[1] = -G[2];
    } else {
      Matrix<3> inertia{};
      for (std::size_t k = 0; k < 9; ++k) inertia[k] = (k % 4 == 0 ? M[0] + M[4] + M[8] : 0) - M[k];
      const Matrix<3> K = inverse(inertia);
      const std::array<double, 3> moment{S[7] - S[5], S[2] - S[6], S[3] - S[1]};
      const auto rate = [&](std::size_t k) {
        return K[3 * k] * moment[0] + K[3 * k + 1] * moment[1] + K[3 * k + 2] * moment[2];
      };
      G = {0, -rate(2), rate(1), rate(2), 0, -rate(0), -rate(1), rate(0), 0};
    }
    Matrix<D> L = product<D>(S, B);
    const Matrix<D> turning = product<D>(G, lacking);
    for (std::size_t k = 0; k < D * D; ++k) L[k] += turning[k];
    gradients.push_back(L);
    double trace = 0, ee = 0;
    for (std::size_t k = 0; k < D; ++k) trace += L[k * D + k];
    for (std::size_t k = 0; k < D; ++k)
      for (std::size_t l = 0; l < D; ++l) ee += std::pow(0.5 * (L[k * D + l] + L[l * D + k]), 2);
    const double V = p.mass[i] / p.rho[i], eta = c.work.viscosity[i];
    sum += V * (eta * (ee - trace * trace / 3) + 0.5 * c.work.bulk[i] * trace * trace);
  }
  if (law_only) return sum;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      if (i == j) continue;
      const double eta = c.work.viscosity[i], other = c.work.viscosity[j], f = geometry(i, j, r);
      double missed = 0, r2 = 0;
      for (std::size_t k = 0; k < D; ++k) {
        double dv = v[k][i] - v[k][j];
        for (std::size_t l = 0; l < D; ++l) dv -= 0.5 * (gradients[i][k * D + l] + gradients[j][k * D + l]) * r[l];
        missed += dv * r[k], r2 += r[k] * r[k];
      }
      const double k_ij =
          2.0 * (D + 2) * (2 * eta * other / (eta + other)) * p.mass[i] / p.rho[i] * p.mass[j] / p.rho[j] * f;
      sum += 0.25 * k_ij * missed * missed / r2;
    }
  return sum;
}

TEST(Twin, CorrectedForceIsTheDerivativeOfThePotential) {
  const auto compare = [](auto dim, int count) {
    constexpr int D = decltype(dim)::value;
    Case c = prepare(free_model(D, true), count, 0.3, 0.2);
    const Field v = velocities(c, 0), w = velocities(c, 5);
    Field force = v, plus = v, minus = v;
    viscous_force(c.work, c.state.particles, c.model, v, force);
    for (std::size_t d = 0; d < D; ++d)
      for (std::size_t i = 0; i < v[d].size(); ++i) plus[d][i] += w[d][i], minus[d][i] -= w[d][i];
    // quadratic: the central difference is exact
    const double slope = 0.5 * (potential<D>(c, plus) - potential<D>(c, minus));
    EXPECT_NEAR(inner(c, force, w) / -slope, 1, 1e-8) << D;
    EXPECT_NEAR(inner(c, force, v) / (-2 * potential<D>(c, v)), 1, 1e-8) << D;
    viscous_force(c.work, c.state.particles, c.model, v, force);
    const LawDissipation law = corrected_dissipation(c.work, c.state.particles, c.model, v);
    EXPECT_NEAR((law.friction + law.bulk) / (2 * potential<D>(c, v, true)), 1, 1e-8) << D;
    EXPECT_GT(law.bulk, 0);
  };
  compare(std::integral_constant<int, 2>{}, 10);
  compare(std::integral_constant<int, 3>{}, 6);
}

TEST(Twin, NeighbourListsHoldExactlyWhatIsNear) {
  for (const int dim : {2, 3}) {
    Model m = free_model(dim, false);
    Case c{m, block(m, dim == 2 ? 17 : 8, 0.4, 0.3), {}};
    Particles& p = c.state.particles;
    rebuild(c.work.pairs, p, m, 0.05);
    const double reach = 2 * m.h() + p.skin;
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      std::vector<int> times(p.mass.size(), 0);
      for (auto q = c.work.pairs.offset[i]; q < c.work.pairs.offset[i + 1]; ++q) {
        const auto j = static_cast<std::size_t>(c.work.pairs.index[static_cast<std::size_t>(q)]);
        if (j < times.size()) ++times[j];
      }
      for (std::size_t j = 0; j < times.size(); ++j) {
        double r2 = 0;
        for (std::size_t d = 0; d < static_cast<std::size_t>(dim); ++d) r2 += std::pow(p.x[d][i] - p.x[d][j], 2);
        ASSERT_EQ(times[j], i != j && r2 < reach * reach ? 1 : 0);
      }
    }
  }
}

// Plain O(N^2) twin of the explicit pair model: density rate, shear rate and acceleration as printed, floor included.
TEST(Twin, PairSweepsMatchTheEquationsAsPrinted) {
  for (const int dim : {2, 3}) {
    Model m = free_model(dim, false);
    m.floor = true;
    m.gravity = {1, -2, 3};
    m.numerics.artificial_viscosity = 0.1;
    Case c{m, block(m, dim == 2 ? 9 : 5, 0.2, 0.2), {}};
    Particles& p = c.state.particles;
    const auto D = static_cast<std::size_t>(dim);
    for (double& z : p.x[D - 1]) z += 5.5;
    c.work.resize(p.size(), dim);
    rebuild(c.work.pairs, p, m, 0);
    p.v = velocities(c, 3);
    for (std::size_t i = 0; i < p.mass.size(); ++i) p.rho[i] *= 1 + 0.1 * random_unit(i, 9);
    kinematics(c.work, p, m, Kinematics::pairs);
    for (std::size_t i = 0; i < p.mass.size(); ++i)
      c.work.pressure[i] = random_unit(i, 7), c.work.viscosity[i] = 1 + random_unit(i, 8);
    pair_momentum_rate(c.work, p, m, true);
    const double h = m.h(), a = (dim == 2 ? 7 / (64 * M_PI) : 21 / (256 * M_PI)) / std::pow(h, dim);
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      double rate = 0;
      std::array<double, 3> acc = m.gravity;
      std::array<std::array<double, 3>, 3> G{};
      const auto pair = [&](const std::array<double, 3>& r, const std::array<double, 3>& v, double mass, double rho,
                            double pj, double eta) {
        double r2 = 0, vr = 0;
        for (std::size_t d = 0; d < D; ++d) r2 += r[d] * r[d], vr += v[d] * r[d];
        const double R = std::sqrt(r2) / h;
        if (R >= 2) return;
        const double dW = -10 * a * R * std::pow(2 - R, 3) / h;  // dW/dr
        const double Pi = -0.1 * h * m.sound_speed() * vr / (0.5 * (rho + p.rho[i]) * r2);
        const double ei = c.work.viscosity[i];
        for (std::size_t d = 0; d < D; ++d) {
          const double gradient = dW * r[d] / std::sqrt(r2);
          rate += mass * v[d] * gradient;
          acc[d] -= mass * (c.work.pressure[i] / (p.rho[i] * p.rho[i]) + pj / (rho * rho) + Pi) * gradient;
          acc[d] += mass * (dim == 2 ? 8 : 10) * 2 * ei * eta / (ei + eta) * vr * gradient / (r2 * p.rho[i] * rho);
          for (std::size_t b = 0; b < D; ++b) G[b][d] -= v[b] * gradient * mass / rho;
        }
      };
      for (std::size_t j = 0; j < p.mass.size(); ++j) {
        if (i == j) continue;
        std::array<double, 3> r{}, v{};
        for (std::size_t d = 0; d < D; ++d) r[d] = p.x[d][i] - p.x[d][j], v[d] = p.v[d][i] - p.v[d][j];
        pair(r, v, p.mass[j], p.rho[j], c.work.pressure[j], c.work.viscosity[j]);
      }
      for (int gx = -12; gx < 12; ++gx)
        for (int gy = dim == 3 ? -12 : 0; gy < (dim == 3 ? 12 : 1); ++gy)
          for (int gz = 0; gz < 3; ++gz) {
            const double height = p.x[D - 1][i], depth = gz + 0.5, beta = std::min(1.5, 1 + depth / height);
            std::array<double, 3> r{p.x[0][i] - gx - 0.5, p.x[1][i] - gy - 0.5, 0}, v{};
            r[D - 1] = height + depth;
            for (std::size_t d = 0; d < D; ++d) v[d] = beta * p.v[d][i];
            pair(r, v, p.mass[i], p.rho[i], c.work.pressure[i], c.work.viscosity[i]);
          }
      double e2 = 0;
      for (std::size_t b = 0; b < D; ++b)
        for (std::size_t d = 0; d < D; ++d) e2 += 0.25 * (G[b][d] + G[d][b]) * (G[b][d] + G[d][b]);
      ASSERT_NEAR(c.work.density_rate[i], -(-rate), 1e-9 * 1600);
      ASSERT_NEAR(c.work.shear_rate[i], std::sqrt(2 * e2), 1e-11);
      for (std::size_t d = 0; d < D; ++d)
        ASSERT_NEAR(c.work.acceleration[d][i], acc[d], 1e-10 * (1 + std::abs(acc[d])));
    }
  }
}

}  // namespace
}  // namespace bagnold::sph::test

// Morris ghost particles: what beta_max means for the no-slip floor.
#include "operators.hpp"

namespace bagnold::sph::test {
namespace {

// Morris ghosts. Rows of a lattice at rest over ghosts pull at each other with A1 (next row) and A2 (the one after), so a
// shear flow without forces is u_k = G dp (k + 1/2 + slip + b q^k) with A1/A2 = -(q + 1/q + 2), |q| < 1, and the two rows
// that feel ghosts, with velocities (1 - beta) u_k of these, decide slip and b. beta = 1 + d_j/d_i, not clipped, continues
// the shear through the wall: no slip. Clipped at beta_max = 1 ghosts rest, at 1.5 they move back half as fast.
struct Slip {
  double slip = 0, b = 0, q = 0;
};
Slip slip_of_ghosts(double A1, double A2, double beta_max) {
  const double sum = -2 - A1 / A2, q = 0.5 * (sum + std::sqrt(sum * sum - 4));
  const auto beta = [&](double depth, double height) { return std::min(beta_max, 1 + depth / height); };
  // Balance of row 0 and row 1, for the profiles (k + 1/2), 1 and q^k.
  std::array<std::array<double, 3>, 2> balance;
  for (int which = 0; which < 3; ++which) {
    const auto u = [&](int k) { return which == 0 ? k + 0.5 : which == 1 ? 1 : std::pow(q, k); };
    balance[0][static_cast<std::size_t>(which)] =
        A1 * (u(1) - u(0) - beta(0.5, 0.5) * u(0)) + A2 * (u(2) - u(0) - beta(1.5, 0.5) * u(0));
    balance[1][static_cast<std::size_t>(which)] =
        A1 * (u(2) - 2 * u(1) + u(0)) + A2 * (u(3) - u(1) - beta(0.5, 1.5) * u(1));
  }
  const auto &m = balance[0], &n = balance[1];
  const double det = m[1] * n[2] - m[2] * n[1];
  return {(m[2] * n[0] - m[0] * n[2]) / det, (m[0] * n[1] - m[1] * n[0]) / det, q};
}

TEST(Ghosts, SlipAsMuchAsTheirBetaSays) {
  for (const int dim : {2, 3})
    for (const double beta_max : {1.0, 1.5, 10.0}) {
      Model m = free_model(dim, false);
      m.floor = true;
      m.period = {8, dim == 3 ? 8.0 : 0.0, 0};
      m.numerics.wall_beta_max = beta_max;
      const int rows = 9;
      State s;
      s.particles = make_particles(dim == 2 ? 8 * rows : 64 * rows, dim);
      Particles& p = s.particles;
      const auto up = static_cast<std::size_t>(dim - 1);
      for (std::size_t i = 0; i < p.mass.size(); ++i) {
        std::size_t rest = i;
        for (std::size_t d = 0; d < up; ++d, rest /= 8) p.x[d][i] = static_cast<double>(rest % 8) + 0.5;
        p.x[up][i] = static_cast<double>(rest) + 0.5;
        p.rho[i] = p.mass[i] = 1600;
      }
      Case c{m, s, {}};
      c.work.resize(p.size(), dim);
      rebuild(c.work.pairs, c.state.particles, m, 0);
      kinematics(c.work, c.state.particles, m, Kinematics::pairs, true);
      std::fill(c.work.pressure.begin(), c.work.pressure.end(), 0);
      std::fill(c.work.viscosity.begin(), c.work.viscosity.end(), 3);
      pair_coefficients(c.work, c.state.particles, m);

      // pull of one row on a particle of another, n spacings away
      const double h = m.h(), norm = 10 * (dim == 2 ? 7 / (64 * M_PI) : 21 / (256 * M_PI)) / std::pow(h, dim + 2);
      const auto row = [&](int n) {
        double sum = 0;
        for (int a = -3; a <= 3; ++a)
          for (int b = dim == 3 ? -3 : 0; b <= (dim == 3 ? 3 : 0); ++b) {
            const double r2 = a * a + b * b + n * n, R = std::sqrt(r2) / h;
            if (R < 2) sum += (dim == 2 ? 8 : 10) * 3 * norm * std::pow(2 - R, 3) * a * a / r2;
          }
        return sum;
      };
      const double A1 = row(1), A2 = row(2), G = 0.7;
      const Slip wall = slip_of_ghosts(A1, A2, beta_max);
      Particles& q = c.state.particles;
      for (std::size_t i = 0; i < q.mass.size(); ++i) {
        const double z = q.x[up][i];
        q.v[0][i] = G * (z + wall.slip + wall.b * std::pow(wall.q, z - 0.5));
      }
      Field force = q.v;
      viscous_force(c.work, q, m, q.v, force);
      kinematics(c.work, q, m, Kinematics::pairs);
      pair_momentum_rate(c.work, q, m, true);  // the explicit form of the same
      const double stress = G * (A1 + 4 * A2);
      for (std::size_t i = 0; i < q.mass.size(); ++i) {
        if (q.x[up][i] > rows - 2) continue;  // rows that miss others above
        EXPECT_NEAR(force[0][i], 0, 1e-10 * stress) << dim << ' ' << beta_max;
        EXPECT_NEAR(c.work.acceleration[0][i] * q.mass[i], 0, 1e-10 * stress) << dim << ' ' << beta_max;
      }
    }
}

// The same in the flow of grains: velocities of rows 1, 2, 3 continued to the floor, over shear rate there and dp. The
// bottom row carries a tenth more pressure than it should and is that much stiffer, which takes 0.1 off each.
TEST(Ghosts, FlowDownAPlaneSlipsAsMuch) {
  const auto slip = [](double beta_max) {
    const scenario::InclinedPlane plane{.angle_deg = 25, .height = 0.06, .length = 0.03, .spacing = 5e-3};
    Model m = incline_model();
    m.numerics.wall_beta_max = beta_max;
    Simulation r = start(plane, m);
    std::array<double, 4> z{}, u{}, count{};
    const Particles& p = r.state.particles;
    for (int sample = 0; sample < 40; ++sample) {
      advance(r, 0.2 + 0.01 * sample);
      for (std::size_t i = 0; i < p.mass.size(); ++i)
        if (const auto row = static_cast<std::size_t>(p.x[1][i] / plane.spacing); row < 4)
          z[row] += p.x[1][i], u[row] += p.v[0][i], count[row] += 1;
    }
    for (std::size_t k = 0; k < 4; ++k) z[k] /= count[k], u[k] /= count[k];
    const double first = (u[2] - u[1]) / (z[2] - z[1]),
                 second = ((u[3] - u[2]) / (z[3] - z[2]) - first) / (z[3] - z[1]);  // Newton's divided differences
    return (u[1] - first * z[1] + second * z[1] * z[2]) / ((first - second * (z[1] + z[2])) * plane.spacing);
  };
  const double still = slip(1), half = slip(1.5), full = slip(10);
  EXPECT_NEAR(still, 0.51, 0.12);
  EXPECT_NEAR(half, 0.17, 0.12);
  EXPECT_NEAR(full, 0, 0.12);
  EXPECT_NEAR(still - half, 0.34, 0.06);
  EXPECT_NEAR(half - full, 0.17, 0.08);
}

}  // namespace
}  // namespace bagnold::sph::test

// Whole steps of bodies that touch nothing: momentum and angular momentum to round-off, order of the scheme.
#include "helpers.hpp"
#include "sph/observe.hpp"

namespace bagnold::sph::test {
namespace {

double sum_of_magnitudes(const State& s, int dim) {
  double sum = 0;
  for (std::size_t d = 0; d < static_cast<std::size_t>(dim); ++d)
    for (std::size_t i = 0; i < s.particles.mass.size(); ++i)
      sum += s.particles.mass[i] * std::abs(s.particles.v[d][i]);
  return sum;
}

// sum m x cross v; in two dimensions the component out of the plane comes last.
std::array<double, 3> angular_momentum(const State& s, int dim) {
  const Particles& p = s.particles;
  std::array<double, 3> L{};
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    L[2] += p.mass[i] * (p.x[0][i] * p.v[1][i] - p.x[1][i] * p.v[0][i]);
    if (dim == 2) continue;
    L[0] += p.mass[i] * (p.x[1][i] * p.v[2][i] - p.x[2][i] * p.v[1][i]);
    L[1] += p.mass[i] * (p.x[2][i] * p.v[0][i] - p.x[0][i] * p.v[2][i]);
  }
  return L;
}

// A block of particles 3 mm apart that flies, spins, is torn and squeezed: random velocities on top of a rotation.
Simulation flying_block(Model m, int count) {
  m.spacing = 3e-3;
  Simulation r{m, block(m, count, 0.3, 0), {}};
  Particles& p = r.state.particles;
  for (auto& x : p.x)
    for (double& c : x) c *= m.spacing;
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    p.mass[i] *= std::pow(m.spacing, m.dim);
    for (std::size_t d = 0; d < static_cast<std::size_t>(m.dim); ++d)
      p.v[d][i] = random_unit(i, 1 + static_cast<std::uint32_t>(d)) - 0.3 - 0.2 * static_cast<double>(d);
    p.v[0][i] -= 40 * p.x[1][i], p.v[1][i] += 40 * p.x[0][i];
  }
  initialise(r.state, r.work, m);
  return r;
}

TEST(Conservation, PrintedStepsKeepMomentumAndAngularMomentumToRoundOff) {
  for (const int dim : {2, 3})
    for (const double alpha : {0.0, 0.1}) {
      Model m = free_model(dim, false);
      m.numerics.artificial_viscosity = alpha;
      Simulation r = flying_block(m, dim == 2 ? 10 : 6);
      const auto P = momentum(r.state, r.model), L = angular_momentum(r.state, dim);
      const double mass = total_mass(r.state), scale = sum_of_magnitudes(r.state, dim), size = 0.015;
      steps(r, 200);
      for (std::size_t d = 0; d < 3; ++d) {
        EXPECT_NEAR(momentum(r.state, r.model)[d], P[d], 1e-13 * scale) << dim << alpha;
        EXPECT_NEAR(angular_momentum(r.state, dim)[d], L[d], 1e-13 * scale * size) << dim << alpha;
      }
      EXPECT_NEAR(total_mass(r.state), mass, 1e-14 * mass);
    }
}

// The implicit solution keeps both up to what its tolerance leaves unbalanced. Shifting moves particles without their
// momentum, so it changes the angular one.
TEST(Conservation, VariationalStepsKeepMomentumAndAngularMomentumToRoundOff) {
  for (const int dim : {2, 3})
    for (const Stepping stepping : {Stepping::implicit, Stepping::explicit_euler}) {
      Model m = free_model(dim, true);
      m.stepping = stepping;
      m.numerics.density_diffusion = 0.03;
      m.numerics.volume_correction = 1;
      Simulation r = flying_block(m, dim == 2 ? 10 : 6);
      const auto P = momentum(r.state, r.model), L = angular_momentum(r.state, dim);
      const double scale = sum_of_magnitudes(r.state, dim), size = 0.015;
      steps(r, 60);
      std::size_t loose = 0;
      for (const double c : r.work.coverage) loose += c < 0.5;
      EXPECT_GT(loose, r.work.coverage.size() / 10);
      for (std::size_t d = 0; d < 3; ++d) {
        EXPECT_NEAR(momentum(r.state, r.model)[d], P[d], 1e-13 * scale) << dim;
        EXPECT_NEAR(angular_momentum(r.state, dim)[d], L[d], 1e-13 * scale * size) << dim;
      }
    }
}

// The printed scheme is of second order when its rates of the middle count for the whole step.
TEST(Conservation, PrintedSchemeIsOfSecondOrder) {
  const auto velocity = [](int count) {
    Model m = free_model(2, false);
    m.material.rheology = laws::rheology::MuI{1e-4, 2e-4, 0.279};  // next to no friction: sound alone
    m.numerics.cfl = 0.4 / count;
    m.numerics.viscous_factor = 1e9;
    Simulation r{m, block(m, 10, 0.3, 0), {}};
    Particles& p = r.state.particles;
    for (std::size_t i = 0; i < p.mass.size(); ++i) p.v[0][i] = -0.2 * p.x[0][i], p.rho[i] *= 1.05;
    initialise(r.state, r.work, m);
    steps(r, 20 * count);
    std::vector<double> v(p.mass.size());
    for (std::size_t i = 0; i < v.size(); ++i) v[static_cast<std::size_t>(p.id[i])] = p.v[0][i];
    return v;
  };
  const auto exact = velocity(32);
  const auto error = [&](int count) {
    const auto v = velocity(count);
    double sum = 0;
    for (std::size_t i = 0; i < v.size(); ++i) sum += (v[i] - exact[i]) * (v[i] - exact[i]);
    return std::sqrt(sum);
  };
  const double coarse = error(2), fine = error(4);
  EXPECT_GT(coarse / fine, 3.5);
  EXPECT_GT(fine, 1e-12);
}

}  // namespace
}  // namespace bagnold::sph::test

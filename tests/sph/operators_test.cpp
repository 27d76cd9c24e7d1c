// The discrete operators: what they are exact for and what they conserve.
#include "operators.hpp"
#include "sph/small_tensor.hpp"

namespace bagnold::sph::test {
namespace {

class Operators : public testing::TestWithParam<std::tuple<int, bool>> {
 protected:
  Model model() const { return free_model(std::get<0>(GetParam()), std::get<1>(GetParam())); }
  int count() const { return std::get<0>(GetParam()) == 2 ? 14 : 8; }
};
INSTANTIATE_TEST_SUITE_P(All, Operators, testing::Combine(testing::Values(2, 3), testing::Bool()));

TEST_P(Operators, ViscousForceIsSymmetricDissipativeAndConservesMomenta) {
  Case c = prepare(model(), count(), 0.3, 0.2);
  const Field a = velocities(c, 0), b = velocities(c, 5);
  Field Aa = a, Ab = a;
  viscous_force(c.work, c.state.particles, c.model, a, Aa);
  viscous_force(c.work, c.state.particles, c.model, b, Ab);
  EXPECT_NEAR(inner(c, b, Aa) / inner(c, a, Ab), 1, 1e-12);
  EXPECT_LT(inner(c, a, Aa), 0);
  EXPECT_LT(balance(c, Aa).force, 1e-14);
  EXPECT_LT(balance(c, Aa).torque, 1e-14);
}

TEST_P(Operators, PressureConservesMomenta) {
  Case c = prepare(model(), count(), 0.3, 0.2);
  Field force = c.work.acceleration;
  for (auto& f : force)
    for (std::size_t i = 0; i < f.size(); ++i) f[i] *= c.state.particles.mass[i];
  EXPECT_LT(balance(c, force).force, 1e-14);
  EXPECT_LT(balance(c, force).torque, 1e-14);
}

TEST_P(Operators, RigidRotationFeelsNoViscosity) {
  Case c = prepare(model(), count(), 0.3, 0.2);
  Field v = velocities(c, 0), force = v;
  viscous_force(c.work, c.state.particles, c.model, v, force);
  const double reference = std::sqrt(inner(c, force, force) / inner(c, v, v));
  const Particles& p = c.state.particles;
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    v[0][i] = -p.x[1][i];
    v[1][i] = p.x[0][i];
    if (c.model.dim == 3) v[2][i] = 0;
  }
  viscous_force(c.work, p, c.model, v, force);
  EXPECT_LT(std::sqrt(inner(c, force, force) / inner(c, v, v)), 1e-13 * reference);
}

// Loose particles, strings, pairs and lone ones: B is not M^-1 there, and momenta are conserved all the same.
TEST_P(Operators, LooseParticlesKeepMomentaToo) {
  if (!model().corrected()) return;
  Model m = model();
  Case c{m, block(m, count(), 0.3, 0.2), {}};
  Particles& p = c.state.particles;
  for (std::size_t i = 0; i < p.mass.size(); ++i)  // a third of them fly apart
    if (random_unit(i, 30) < 0.33)
      for (std::size_t d = 0; d < static_cast<std::size_t>(m.dim); ++d) p.x[d][i] *= 2.2;
  for (std::size_t k = 0; k < 5; ++k) {  // a straight string and a far pair
    for (std::size_t d = 0; d < static_cast<std::size_t>(m.dim); ++d)
      p.x[d][k] = k < 3 ? 50 + 1.0 * static_cast<double>(k) : 80 + 0.7 * static_cast<double>(k);
  }
  c.work.resize(p.size(), m.dim);
  rebuild(c.work.pairs, p, m, 0);
  kinematics(c.work, p, m, Kinematics::corrected, true);
  std::size_t loose = 0;
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    c.work.pressure[i] = random_unit(i, 7), c.work.viscosity[i] = random_unit(i, 8);
    c.work.bulk[i] = random_unit(i, 9);
    loose += c.work.coverage[i] < blend_to;
  }
  EXPECT_GT(loose, p.mass.size() / 5);
  corrected_pressure_and_coefficients(c.work, p, m);
  Field force = c.work.acceleration;
  for (auto& f : force)
    for (std::size_t i = 0; i < f.size(); ++i) f[i] *= p.mass[i];
  EXPECT_LT(balance(c, force).torque, 1e-13);
  const Field a = velocities(c, 0), b = velocities(c, 5);
  Field Aa = a, Ab = a;
  viscous_force(c.work, p, m, a, Aa);
  viscous_force(c.work, p, m, b, Ab);
  EXPECT_NEAR(inner(c, b, Aa) / inner(c, a, Ab), 1, 1e-11);
  EXPECT_LT(inner(c, a, Aa), 0);
  EXPECT_LT(balance(c, Aa).force, 1e-14);
  EXPECT_LT(balance(c, Aa).torque, 1e-13);
}

// Power of uniform shear against 2 V eta e:e: the ratio of measured to true stress (the patch test).
double patch_factor(const Model& base, double angle, double disorder, int count) {
  Model model = base;
  if (model.corrected()) model.viscous = laws::viscous::Variational{};
  Case c = prepare(model, count, angle, disorder);
  std::fill(c.work.viscosity.begin(), c.work.viscosity.end(), 1.0);
  if (model.corrected())
    corrected_pressure_and_coefficients(c.work, c.state.particles, model);
  else
    pair_coefficients(c.work, c.state.particles, model);
  Field v = c.state.particles.v, force = v;
  const Particles& p = c.state.particles;
  for (std::size_t i = 0; i < p.mass.size(); ++i) v[0][i] = p.x[1][i];
  viscous_force(c.work, p, model, v, force);
  // Virial theorem on a free block: sum x F_z = -sum V tau. The surface layer is part of it.
  double virial = 0, volume = 0;
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    virial -= 0.5 * (p.x[0][i] * force[1][i] + p.x[1][i] * force[0][i]);
    volume += c.work.volume[i];
  }
  return virial / volume;
}

// Extrapolated from two block sizes to no surface: the value inside.
double bulk_factor(const Model& model, double angle, double disorder, int count) {
  return 2 * patch_factor(model, angle, disorder, 2 * count) - patch_factor(model, angle, disorder, count);
}

TEST(PatchTest, VariationalStressIsExactOnEveryArrangement) {
  for (const double angle : {0.0, 0.2, 0.4, M_PI / 4, 1.2})
    for (const double disorder : {0.0, 0.1, 0.25})
      EXPECT_NEAR(bulk_factor(free_model(2, true), angle, disorder, 20), 1, 0.01) << angle << ' ' << disorder;
  EXPECT_NEAR(bulk_factor(free_model(3, true), 0.3, 0.1, 10), 1, 0.04);
}

TEST(PatchTest, PairStressDependsOnLatticeAngle) {
  EXPECT_NEAR(bulk_factor(free_model(2, false), 0, 0, 20), 0.81, 0.02);
  EXPECT_NEAR(bulk_factor(free_model(2, false), M_PI / 4, 0, 20), 1.14, 0.02);
}

TEST(Kinematics, CorrectedGradientIsExactForLinearFields) {
  for (const int dim : {2, 3}) {
    Case c = prepare(free_model(dim, true), dim == 2 ? 14 : 8, 0.5, 0.2);
    Particles& p = c.state.particles;
    Matrix<3> G{};
    for (std::size_t k = 0; k < 9; ++k) G[k] = random_unit(k, 60) - 0.5;
    for (std::size_t i = 0; i < p.mass.size(); ++i)
      for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
        p.v[a][i] = 0;
        for (std::size_t b = 0; b < static_cast<std::size_t>(dim); ++b) p.v[a][i] += G[3 * a + b] * p.x[b][i];
      }
    kinematics(c.work, p, c.model, Kinematics::corrected, true);
    int checked = 0;
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      if (c.work.coverage[i] < 0.5) continue;
      ++checked;
      for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a)
        for (std::size_t b = 0; b < static_cast<std::size_t>(dim); ++b)
          ASSERT_NEAR(c.work.gradient[(i * static_cast<std::size_t>(dim) + a) * static_cast<std::size_t>(dim) + b],
                      G[3 * a + b], 1e-12);
    }
    EXPECT_GT(checked, p.size() / 2);
  }
}

// Pressure force is minus the adjoint of the corrected divergence, floor images included: sum m a.v = sum p V tr L.
TEST(Adjoint, PressureIsTheAdjointOfTheDivergence) {
  for (const bool floor : {false, true}) {
    Model m = free_model(2, true);
    m.floor = floor;
    Case c{m, block(m, 12, 0, 0.15), {}};
    Particles& p = c.state.particles;
    for (double& z : p.x[1]) z += 6.2;
    c.work.resize(p.size(), 2);
    rebuild(c.work.pairs, p, m, 0);
    p.v = velocities(c, 3);
    kinematics(c.work, p, m, Kinematics::corrected, true);
    for (std::size_t i = 0; i < p.mass.size(); ++i) c.work.pressure[i] = random_unit(i, 7), c.work.viscosity[i] = 0;
    corrected_pressure_and_coefficients(c.work, p, m);
    double work_of_force = 0, work_of_pressure = 0;
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      for (std::size_t d = 0; d < 2; ++d) work_of_force += p.mass[i] * c.work.acceleration[d][i] * p.v[d][i];
      work_of_pressure += c.work.pressure[i] * c.work.volume[i] * -c.work.density_rate[i] / p.rho[i];
    }
    EXPECT_NEAR(work_of_force / work_of_pressure, 1, 1e-12);
  }
}

// Axisymmetric: same adjoint with hoop strain; and the operator stays symmetric with floor and axis images.
TEST(Adjoint, AxisymmetricOperatorsAreAdjointAndSymmetric) {
  Model m = free_model(2, true);
  m.axisymmetric = true;
  m.floor = true;
  Case c{m, block(m, 12, 0, 0.15), {}};
  Particles& p = c.state.particles;
  for (std::size_t i = 0; i < p.mass.size(); ++i) p.x[0][i] += 6.2, p.x[1][i] += 6.2, p.mass[i] *= 2 * M_PI * p.x[0][i];
  c.work.resize(p.size(), 2);
  rebuild(c.work.pairs, p, m, 0);
  p.v = velocities(c, 3);
  kinematics(c.work, p, m, Kinematics::corrected, true);
  for (std::size_t i = 0; i < p.mass.size(); ++i)
    c.work.pressure[i] = random_unit(i, 7), c.work.viscosity[i] = random_unit(i, 8);
  corrected_pressure_and_coefficients(c.work, p, m);
  double work_of_force = 0, work_of_pressure = 0;
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    for (std::size_t d = 0; d < 2; ++d) work_of_force += p.mass[i] * c.work.acceleration[d][i] * p.v[d][i];
    work_of_pressure += c.work.pressure[i] * c.work.volume[i] * -c.work.density_rate[i] / p.rho[i];
  }
  EXPECT_NEAR(work_of_force / work_of_pressure, 1, 1e-12);
  const Field a = velocities(c, 0), b = velocities(c, 5);
  Field Aa = a, Ab = a;
  viscous_force(c.work, p, m, a, Aa);
  viscous_force(c.work, p, m, b, Ab);
  EXPECT_NEAR(inner(c, b, Aa) / inner(c, a, Ab), 1, 1e-12);
  EXPECT_LT(inner(c, a, Aa), 0);
}

}  // namespace
}  // namespace bagnold::sph::test

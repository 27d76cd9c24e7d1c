// What the implicit solver and the toe of a flow stand on: density stays positive, and the viscous operator is symmetric and dissipative whatever
// particles do, at the axis, on the floor, in clusters, diluted or alone.
#include <vector>

#include "helpers.hpp"
#include "sph/forces.hpp"
#include "sph/implicit.hpp"
#include "sph/kinematics.hpp"
#include "sph/order.hpp"

namespace bagnold::sph::test {
namespace {

double inner(const Field& a, const Field& b) {
  double sum = 0;
  for (std::size_t d = 0; d < 2; ++d)
    for (std::size_t i = 0; i < a[d].size(); ++i) sum += a[d][i] * b[d][i];
  return sum;
}

// A disordered heap of unit particles on the floor at the axis: some at the axis, some on the floor, some all but
// coinciding, a few thrown off, densities and viscosities over decades.
Simulation untidy(double residual, bool axisymmetric) {
  Model m = free_model(2, true);
  m.viscous = laws::viscous::Variational{.residual = residual};
  m.axisymmetric = axisymmetric;
  m.floor = true;
  Simulation r{m, block(m, 14, 0, 0.45), {}};
  Particles& p = r.state.particles;
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    p.x[0][i] = std::max(p.x[0][i] + 6.5, 0.02), p.x[1][i] = std::max(p.x[1][i] + 6.5, 0.02);
    if (i % 17 == 3) p.x[0][i] = p.x[0][i - 1] + 1e-3, p.x[1][i] = p.x[1][i - 1] - 1e-3;
    if (i % 23 == 5) p.x[0][i] += 14, p.x[1][i] = 0.02 + 2 * random_unit(i, 30);
    p.rho[i] = 1600 * std::pow(10, -1.5 * std::pow(random_unit(i, 31), 6));
    p.mass[i] = 1600 * (axisymmetric ? 2 * M_PI * p.x[0][i] : 1);
  }
  r.work.resize(p.size(), 2);
  rebuild(r.work.pairs, p, m, 0);
  kinematics(r.work, p, m, Kinematics::corrected, true);
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    const auto id = static_cast<std::uint64_t>(p.id[i]);
    r.work.pressure[i] = 0;
    r.work.viscosity[i] = std::pow(10, 10 * random_unit(id, 32) - 4);
    r.work.bulk[i] = r.work.viscosity[i] * random_unit(id, 33);
  }
  corrected_pressure_and_coefficients(r.work, p, m);
  return r;
}

class Positivity : public testing::TestWithParam<std::tuple<double, bool>> {};
INSTANTIATE_TEST_SUITE_P(All, Positivity, testing::Combine(testing::Values(0.3, 1.0), testing::Bool()));

TEST_P(Positivity, ViscosityIsSymmetricAndNeverDrives) {
  Simulation r = untidy(std::get<0>(GetParam()), std::get<1>(GetParam()));
  const Particles& p = r.state.particles;
  const std::size_t n = p.mass.size();
  // Random everywhere, or only about one particle (the others at rest), every particle in turn.
  const auto field = [&](std::uint32_t draw, std::size_t centre) {
    Field v = p.v;
    for (std::size_t d = 0; d < 2; ++d)
      for (std::size_t i = 0; i < n; ++i) {
        const bool near = centre == n || std::hypot(p.x[0][i] - p.x[0][centre], p.x[1][i] - p.x[1][centre]) < 1.5;
        v[d][i] = near ? random_unit(i, draw + static_cast<std::uint32_t>(d)) - 0.5 : 0;
      }
    return v;
  };
  for (std::size_t centre = 0; centre <= n; ++centre) {
    const Field a = field(0, centre), b = field(5, centre);
    Field Aa = a, Ab = b;
    viscous_force(r.work, p, r.model, a, Aa);
    viscous_force(r.work, p, r.model, b, Ab);
    const double aa = inner(a, Aa), bb = inner(b, Ab);
    EXPECT_LT(aa, 0) << centre;
    EXPECT_LT(bb, 0) << centre;
    EXPECT_NEAR(inner(a, Ab), inner(b, Aa), 1e-11 * std::sqrt(aa * bb)) << centre;
  }
}

// Why densities are advanced exponentially: a negative one is a negative volume, whose viscosity drives.
TEST(Positivity, ViscosityOfNegativeVolumesDrives) {
  Simulation r = untidy(0.3, true);
  Particles& p = r.state.particles;
  std::size_t i = 0;
  while (p.x[0][i] < 3 || p.x[1][i] < 3 || p.x[0][i] > 10) ++i;  // no image of itself in reach
  std::fill(r.work.viscosity.begin(), r.work.viscosity.end(), 0.0);
  std::fill(r.work.bulk.begin(), r.work.bulk.end(), 0.0);
  r.work.viscosity[i] = 1;
  for (const double sign : {1.0, -1.0}) {
    p.rho[i] = sign * std::abs(p.rho[i]);
    update_volumes(r.work, p);
    corrected_pressure_and_coefficients(r.work, p, r.model);
    Field v = p.v, force = v;
    v[0][i] = v[1][i] = 1;
    viscous_force(r.work, p, r.model, v, force);
    EXPECT_LT(sign * inner(v, force), 0);
  }
}

// A ring that leaves the axis doubles its radius many times in one step.
TEST(Density, StaysPositiveHoweverFastAParticleDilutes) {
  Simulation r = start(small_column, scenario::ColumnGeometry::axisymmetric, improved(Model{}));
  Particles& p = r.state.particles;
  std::size_t inner_ring = 0;
  for (std::size_t i = 0; i < p.mass.size(); ++i)
    if (p.x[0][i] < p.x[0][inner_ring]) inner_ring = i;
  p.x[0][inner_ring] = 0.02 * r.model.spacing;
  p.v[0][inner_ring] = 3;
  r.state.dt = 1;  // no slow start
  const std::int64_t id = p.id[inner_ring];
  step(r.state, r.work, r.model);
  std::size_t now = 0;
  while (p.id[now] != id) ++now;
  EXPECT_GT(3 * r.state.dt, 5 * 0.02 * r.model.spacing);  // 5 radii: 1 - dt tr L < 0
  for (const double rho : p.rho) EXPECT_GT(rho, 0);
  EXPECT_LT(p.rho[now], 0.5 * 0.6 * 2600);
}

// Dilute particles whose volumes overlap have been diluted too far, and are given back what their places leave them.
TEST(Density, DiluteVolumesDoNotOverlap) {
  Model m = improved(Model{});
  m.spacing = 1;
  m.numerics.volume_correction = 0;  // the part that works inside, tested elsewhere
  const double rest = 0.6 * 2600, loosest = 0.5 * 2600;
  State s = block(m, 6, 0.2, 0.2, rest);
  for (double& z : s.particles.x[1]) z += 10;  // far from the floor
  for (const double dilution : {0.9, 0.7, 0.1}) {
    Simulation r{m, s, {}};
    Particles& p = r.state.particles;
    for (double& rho : p.rho) rho *= dilution;
    r.work.resize(p.size(), 2);
    rebuild(r.work.pairs, p, m, 0);
    const double lattice = lattice_concentration(m);
    for (int k = 0; k < 40; ++k) {
      const std::vector<double> before = p.rho;
      kinematics(r.work, p, m, Kinematics::corrected, true);
      correct_volumes(r.work, p, m, 1e-3);
      for (std::size_t i = 0; i < p.mass.size(); ++i) {
        EXPECT_GE(p.rho[i], before[i]);
        if (before[i] >= loosest) {
          EXPECT_EQ(p.rho[i], before[i]);  // the range of the dense law is left alone
        }
        EXPECT_LE(p.rho[i], std::max(before[i], loosest));
      }
    }
    kinematics(r.work, p, m, Kinematics::corrected, true);
    for (std::size_t i = 0; i < p.mass.size(); ++i)
      if (p.rho[i] < loosest && r.work.coverage[i] < 0.9) {
        EXPECT_LT(r.work.concentration[i], 1.01 * lattice);
      }
  }
}

// A lone lump on the floor is a layer of depth D: dv/dt = -mu(i) g, i = 5/2 v d/(D sqrt(phi g D)), until it stops.
TEST(Floor, LoneParticleSlidesToRestByTheLaw) {
  Model m = improved(Model{});
  Simulation r{m, {}, {}};
  set_geometry(small_column, scenario::ColumnGeometry::planar, r.model);
  r.state.particles = make_particles(1, 2);
  Particles& p = r.state.particles;
  const double rho = 1000, depth = r.model.spacing, g = 9.81, v0 = 1;
  p.x[0][0] = 0.5, p.x[1][0] = 0, p.v[0][0] = v0;
  p.rho[0] = rho, p.mass[0] = rho * depth * depth;
  initialise(r.state, r.work, r.model);
  step(r.state, r.work, r.model);
  const double start = r.state.time, before = p.v[0][0], d = r.model.material.grain_diameter;
  advance(r, start + 0.05);
  const laws::rheology::MuI law;
  double expected = before;
  const int parts = 10000;
  for (int k = 0; k < parts; ++k)
    expected -=
        (r.state.time - start) / parts * g * law.mu(2.5 * expected * d / (depth * std::sqrt(rho / 2600 * g * depth)));
  EXPECT_NEAR(p.v[0][0] / expected, 1, 0.01);
  EXPECT_LT(p.v[0][0], before - 1.1 * law.static_friction() * g * 0.05);  // more than Coulomb alone
  advance(r, start + v0 / (law.static_friction() * g));
  EXPECT_EQ(p.v[0][0], 0);
}

// One that falls on the floor and is carried by the pressure of its own image slides no farther: pressed by its weight, it
// feels mu(i) of it, whatever the height at which it comes to rest.
TEST(Floor, LoneParticleThatFallsIsStoppedToo) {
  for (const int dim : {2, 3}) {
    Model m = improved(Model{});
    m.material.regularisation = laws::regularisation::Minatti2015{795, 1e3};
    Simulation r{m, {}, {}};
    set_geometry(small_column, dim == 2 ? scenario::ColumnGeometry::planar : scenario::ColumnGeometry::cylinder,
                 r.model);
    r.state.particles = make_particles(1, dim);
    Particles& p = r.state.particles;
    const double depth = r.model.spacing, v0 = 1, g = 9.81;
    const auto up = static_cast<std::size_t>(dim - 1);
    p.x[up][0] = 2 * depth, p.v[0][0] = v0, p.v[up][0] = -0.3;
    p.rho[0] = 1354, p.mass[0] = p.rho[0] * std::pow(depth, dim);
    initialise(r.state, r.work, r.model);
    advance(r, 0.03);
    if (dim == 2) {
      EXPECT_GT(p.x[up][0], 0.2 * depth);  // it lies on its image; in 3D it sinks to the floor
    }
    EXPECT_LT(p.v[0][0], v0);
    advance(r, 0.03 + v0 / (r.model.static_friction() * g));
    EXPECT_LT(std::abs(p.v[0][0]), 0.01 * v0);
  }
}

}  // namespace
}  // namespace bagnold::sph::test

// Friction and the Lode angle: the laws against the invariants they are named after, and what the solver makes of them.
#include <functional>

#include "core/error.hpp"
#include "operators.hpp"
#include "sph/constitutive.hpp"
#include "sph/energy.hpp"
#include "sph/small_tensor.hpp"

namespace bagnold::sph::test {
namespace {

using laws::yield_surface::LadeDuncan;
using laws::yield_surface::MatsuokaNakai;
using Principal = std::array<double, 3>;

// Principal stresses of mean 1, compression positive; m = sqrt(J2)/p, theta = 0 in triaxial compression.
Principal stresses(double m, double theta) {
  Principal s;
  for (std::size_t k = 0; k < 3; ++k)
    s[k] = 1 + 2 / std::sqrt(3.0) * m * std::cos(theta - 2 * M_PI / 3 * static_cast<double>(k));
  return s;
}
double first(const Principal& s) { return s[0] + s[1] + s[2]; }
double second(const Principal& s) { return s[0] * s[1] + s[1] * s[2] + s[2] * s[0]; }
double third(const Principal& s) { return s[0] * s[1] * s[2]; }

// The invariant at the strength of the law is the one of plane strain, all around.
template <class Law>
void expect_constant(const std::function<double(const Principal&)>& invariant) {
  for (std::uint64_t draw = 0; draw < 2000; ++draw) {
    const double mu = std::tan((5 + 38 * random_unit(draw, 0)) * M_PI / 180), theta = 2 * M_PI * random_unit(draw, 1);
    const auto strong = stresses(Law::shape(mu)(std::cos(3 * theta)) * mu, theta), plane = stresses(mu, M_PI / 6);
    EXPECT_GT(*std::min_element(strong.begin(), strong.end()), 0);
    ASSERT_NEAR(invariant(strong) / invariant(plane), 1, 1e-11) << Law::name << ' ' << mu << ' ' << theta;
  }
}

TEST(YieldSurface, IsTheConeItIsNamedAfter) {
  expect_constant<MatsuokaNakai>([](const Principal& s) { return first(s) * second(s) / third(s); });
  expect_constant<LadeDuncan>([](const Principal& s) { return std::pow(first(s), 3) / third(s); });
}

TEST(YieldSurface, IsOneInPlaneStrainStrongInCompressionAndConvex) {
  laws::YieldSurfaces::for_each([](const auto& law) {
    SCOPED_TRACE(std::string(law.name));
    for (double angle = 1; angle <= 40; angle += 1) {
      const double mu = std::tan(angle * M_PI / 180);
      const auto shape = law.shape(mu);
      EXPECT_NEAR(shape(0.0), 1, 1e-15);
      EXPECT_GE(shape(1.0), 1);
      // The hexagon is sharp at both ends; every other curve is weakest in extension.
      EXPECT_LE(shape(-1.0), law.name == laws::yield_surface::MohrCoulomb::name ? shape(1.0) * (1 + 1e-15) : 1);
      // Of three neighbouring points the middle one lies on or outside the chord.
      constexpr double step = M_PI / 180;
      for (double theta = 0; theta < M_PI; theta += step) {
        const double before = shape(std::cos(3 * (theta - step))), here = shape(std::cos(3 * theta)),
                     after = shape(std::cos(3 * (theta + step)));
        EXPECT_GE(here * (before + after) * std::cos(step), before * after * (1 - 1e-12)) << angle << ' ' << theta;
      }
    }
  });
}

// Matsuoka & Nakai's cone goes through the corners of Mohr and Coulomb's pyramid: one friction angle in triaxial compression
// and extension. In plane strain sin(phi) = mu, which is larger.
TEST(YieldSurface, MatsuokaNakaiHasOneTriaxialFrictionAngle) {
  for (const double angle : {10.0, 20.9, 30.5, 40.0}) {
    const double mu = std::tan(angle * M_PI / 180);
    const auto sine = [&](double theta) {
      const Principal s = stresses(MatsuokaNakai::shape(mu)(std::cos(3 * theta)) * mu, theta);
      return (s[0] - s[2]) / (s[0] + s[2]);
    };
    EXPECT_NEAR(sine(0), sine(M_PI / 3), 1e-12);
    EXPECT_NEAR(sine(M_PI / 6), mu, 1e-12);
    EXPECT_LT(sine(0), mu);
  }
}

// The hexagon has sin(phi) = mu at every Lode angle, and Matsuoka & Nakai's cone of the same triaxial angle goes through its corners.
TEST(YieldSurface, MohrCoulombHasOneFrictionAngleEverywhere) {
  using laws::yield_surface::MohrCoulomb;
  for (const double angle : {10.0, 20.9, 30.5, 40.0}) {
    const double mu = std::tan(angle * M_PI / 180);
    const auto sine = [](const Principal& s) { return (s[0] - s[2]) / (s[0] + s[2]); };
    for (double theta = 0; theta <= M_PI / 3; theta += M_PI / 30)
      EXPECT_NEAR(sine(stresses(MohrCoulomb::shape(mu)(std::cos(3 * theta)) * mu, theta)), mu, 1e-12) << theta;
    const auto cone = MatsuokaNakai::shape(mu);
    const double triaxial = sine(stresses(cone(1) * mu, 0));
    EXPECT_NEAR(MohrCoulomb::shape(triaxial)(1) * triaxial, cone(1) * mu, 1e-12);
    EXPECT_NEAR(MohrCoulomb::shape(triaxial)(-1) * triaxial, cone(-1) * mu, 1e-12);
  }
}

// A cone of measured strength: that strength in triaxial compression, a circle without any, and between the two the cones
// above where theirs is the same.
TEST(YieldSurface, TriaxialRatioIsWhatItSays) {
  using laws::yield_surface::TriaxialRatio;
  for (const double ratio : {1.0, 1.05, 1.13, 1.4, 1.7})
    EXPECT_NEAR(TriaxialRatio{ratio}.shape(0.5)(1.0), ratio, 1e-12);
  for (double theta = 0; theta < M_PI; theta += 0.1) {
    EXPECT_NEAR(TriaxialRatio{1}.shape(0.5)(std::cos(3 * theta)), 1, 1e-14);
    const auto lade = LadeDuncan::shape(0.589);
    EXPECT_NEAR(TriaxialRatio{lade(1)}.shape(0.589)(std::cos(3 * theta)), lade(std::cos(3 * theta)), 1e-12);
  }
}

// A homogeneous motion v = rate (-x/2, [-y/2,] z) of a block, or of rings, and the friction it meets.
struct Triaxial {
  Case c;
  double lode = 0, friction = 0;  // of particles well inside: mean cos(3 theta), mean eta gamma/p over mu(i)
  double power = 0;               // of the viscous force, over mu(i) p gamma summed over volumes
};
Triaxial strain(Model model, bool axisymmetric, double disorder, double rate) {
  model.axisymmetric = axisymmetric;
  model.material.yield_surface = MatsuokaNakai{};
  model.material.regularisation = laws::regularisation::Minatti2015{1e4, 1e4};
  if (model.corrected()) model.viscous = laws::viscous::Variational{};
  Triaxial t{{model, block(model, model.dim == 2 ? 20 : 12, 0, disorder), {}}};
  Particles& p = t.c.state.particles;
  const auto up = static_cast<std::size_t>(model.vertical());
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    if (axisymmetric) p.x[0][i] += 20, p.mass[i] *= 2 * M_PI * p.x[0][i];
    for (std::size_t d = 0; d <= up; ++d) p.v[d][i] = (d == up ? 1 : -0.5) * rate * p.x[d][i];
  }
  Work& w = t.c.work;
  initialise(t.c.state, w, model);
  kinematics(w, p, model, model.corrected() ? Kinematics::corrected : Kinematics::pairs, true);
  constitutive(w, p, model);
  const laws::rheology::MuI law;
  double inside = 0, expected = 0;
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    const double mu = law.mu(inertial_number(model, w.shear_rate[i], p.root[i]));
    expected += mu * w.pressure[i] * w.shear_rate[i] * w.volume[i];
    if (w.coverage[i] < 0.9) continue;
    t.lode += w.lode[i], inside += 1;
    t.friction += w.viscosity[i] * w.shear_rate[i] / (w.pressure[i] * mu);
  }
  t.lode /= inside, t.friction /= inside;
  EXPECT_GT(inside, 100);
  if (model.corrected()) {
    corrected_pressure_and_coefficients(w, p, model);
    Field force = p.v;
    viscous_force(w, p, model, p.v, force);
    t.power = -inner(t.c, force, p.v) / expected;
  }
  return t;
}

TEST(YieldSurface, HomogeneousTriaxialFlowMeetsItsFriction) {
  const double mu = laws::rheology::MuI{}.static_friction();
  const auto shape = MatsuokaNakai::shape(mu);
  EXPECT_NEAR(shape(1), 1.2729, 1e-4);
  EXPECT_NEAR(shape(-1), 0.8884, 1e-4);
  for (const double rate : {-1.0, 1.0}) {  // compression along the vertical, extension
    for (const bool axisymmetric : {true, false}) {
      const Triaxial t = strain(free_model(axisymmetric ? 2 : 3, true), axisymmetric, 0.1, rate);
      EXPECT_NEAR(t.lode, -rate, 1e-9);
      EXPECT_NEAR(t.friction / shape(-rate), 1, 0.01);
      EXPECT_NEAR(t.power / shape(-rate), 1, 0.01);
    }
    const Triaxial printed = strain(free_model(3, false), false, 0, rate);  // on the lattice its errors are isotropic
    EXPECT_NEAR(printed.lode, -rate, 1e-3);                                 // edges included
    EXPECT_NEAR(printed.friction / shape(-rate), 1, 0.01);
  }
}

TEST(YieldSurface, LodeParameterNamesTheKindOfStrain) {
  EXPECT_NEAR((lode_parameter<3>({0.5, 0, 0, 0, 0.5, 0, 0, 0, -1}, 0)), 1, 1e-15);
  EXPECT_NEAR((lode_parameter<3>({-0.5, 0, 0, 0, -0.5, 0, 0, 0, 1}, 0)), -1, 1e-15);
  EXPECT_EQ((lode_parameter<3>({0, 0, 7, 0, 0, 0, 0, 0, 0}, 0)), 0);
  EXPECT_EQ((lode_parameter<3>({0, 3, 2, -3, 0, 1, -2, -1, 0}, 0)), 0);  // a rotation
  EXPECT_EQ((lode_parameter<2>({0, 0, 0, 0}, 0)), 0);
  for (std::uint64_t draw = 0; draw < 200; ++draw) {  // rings are a 3D motion; dilation and size do not matter
    Matrix<2> L;
    for (std::uint32_t k = 0; k < 4; ++k) L[k] = random_unit(draw, k) - 0.5;
    const double hoop = random_unit(draw, 4) - 0.5, more = 3 * random_unit(draw, 5),
                 by = 10 * random_unit(draw, 6) + 0.1;
    const double plain = lode_parameter<2>(L, hoop);
    EXPECT_NEAR((lode_parameter<3>({L[0], 0, L[1], 0, hoop, 0, L[2], 0, L[3]}, 0)), plain, 1e-12);
    EXPECT_NEAR((lode_parameter<2>({by * L[0] + more, by * L[1], by * L[2], by * L[3] + more}, by * hoop + more)),
                plain, 1e-9);
  }
}

// Plane flow is plane strain: the same bits whatever the surface.
TEST(YieldSurface, PlaneFlowDoesNotSeeIt) {
  for (const bool better : {false, true}) {
    Model circle = better ? improved(Model{}) : Model{}, cone = circle;
    cone.material.yield_surface = MatsuokaNakai{};
    Simulation a = start(small_column, scenario::ColumnGeometry::planar, circle),
               b = start(small_column, scenario::ColumnGeometry::planar, cone);
    steps(a, 60), steps(b, 60);
    for (const std::size_t d : {0u, 1u}) {
      EXPECT_TRUE(a.state.particles.x[d] == b.state.particles.x[d]);
      EXPECT_TRUE(a.state.particles.v[d] == b.state.particles.v[d]);
    }
  }
}

// A column of rings is compressed as it spreads: the more the law makes of that, the less energy is released.
TEST(YieldSurface, ColumnOfRingsIsHeldBack) {
  const auto released = [](laws::YieldSurfaces::Any surface) {
    Model m = improved(Model{});
    m.material.yield_surface = surface;
    Simulation r = start(scenario::ContinuumColumn{.radius = 0.03, .height = 0.06, .spacing = 3e-3},
                         scenario::ColumnGeometry::axisymmetric, m);
    const double before = potential_energy(r.state, r.model);
    advance(r, 0.1);
    return 1 - potential_energy(r.state, r.model) / before;
  };
  const double circle = released(laws::yield_surface::DruckerPrager{}), near = released(LadeDuncan{}),
               cone = released(MatsuokaNakai{});
  EXPECT_LT(near, 0.99 * circle);
  EXPECT_LT(cone, 0.99 * near);
  EXPECT_GT(cone, 0.8 * circle);
}

TEST(YieldSurface, ConesNeedFrictionBelowOne) {
  Model m = incline_model();
  m.material.rheology = laws::rheology::MuI{46, 50, 0.3};
  EXPECT_NO_THROW(check(m));
  m.material.yield_surface = MatsuokaNakai{};
  EXPECT_THROW(check(m), UnphysicalError);
}

}  // namespace
}  // namespace bagnold::sph::test

// What a simulation is made of: material laws, numerical choices, geometry.
#pragma once
#include <array>
#include <string_view>

#include "core/fields.hpp"
#include "laws/registries.hpp"

namespace bagnold::sph {

struct Material {
  double grain_diameter = 0.32e-3;  // d0, m
  laws::Rheologies::Any rheology;
  laws::YieldSurfaces::Any yield_surface;
  laws::Dilatancies::Any dilatancy;
  laws::GrainEos::Any eos;
  laws::Regularisations::Any regularisation;
};

// minatti2015: explicit, symplectic midpoint. implicit: viscosity solved for v(n+1). explicit_euler: the same order
// of operations as implicit with the viscous force at v(n), for comparison.
enum class Stepping { minatti2015, implicit, explicit_euler };

struct Numerics {
  static constexpr std::string_view name = "numerics";
  static constexpr std::string_view summary =
      "discretisation; stepping = minatti2015 (explicit, as printed), implicit or explicit_euler; laws: operator, "
      "kernel, mean";
  double smoothing_ratio = 1.3;  // h/dp
  double cfl = 0.5;
  double viscous_factor = 0.1;      // explicit: dt < cfl viscous_factor rho h^2/eta
  double artificial_viscosity = 0;  // alpha of eq. 38, minatti2015 operator only
  double wall_beta_max = 1.5;       // Morris ghosts of the minatti2015 operator
  double shifting = 0;              // particle shifting, 10 is usual
  double volume_correction = 0;     // pulls the density back to the one of the positions, 1 is usual
  double density_diffusion = 0;     // delta: removes the alternating pressure no gradient sees, 0.1 is usual
  double base_friction = 0;         // Coulomb friction of particles the floor stops, over mu(i)
  double cg_tolerance = 1e-3;       // what is left of the momentum balance, rms, over g
  std::int64_t cg_max_iterations = 5000;
  static constexpr auto fields() {
    using S = Numerics;
    return std::tuple{
        field("smoothing_ratio", "", "h/dp", &S::smoothing_ratio, closed(1, 3)),
        field("cfl", "", "step over h/c (eq. 39)", &S::cfl, open(0, 1)),
        field("viscous_factor", "", "explicit viscous limit over rho h^2/eta (eq. 39)", &S::viscous_factor, positive()),
        field("artificial_viscosity", "", "alpha of eq. 38 (minatti2015 operator)", &S::artificial_viscosity,
              non_negative()),
        field("wall_beta_max", "", "beta_max of eq. 36 (minatti2015 operator)", &S::wall_beta_max, closed(1, 10)),
        field("shifting", "", "shift = this h^2 gamma dt grad C, 0 for none", &S::shifting, non_negative()),
        field("volume_correction", "", "rate, over gamma, at which rho follows the positions; 0 for none",
              &S::volume_correction, closed(0, 10)),
        field("density_diffusion", "", "delta of the density diffusion (variational operator), 0 for none",
              &S::density_diffusion, closed(0, 1)),
        field("base_friction", "", "1: particles the floor stops feel friction mu(i), 0: they slide", &S::base_friction,
              closed(0, 1)),
        field("cg_tolerance", "", "implicit: rms acceleration left unbalanced, over g", &S::cg_tolerance, open(0, 1)),
        field("cg_max_iterations", "", "implicit: more is an error", &S::cg_max_iterations, at_least(1))};
  }
};

struct Model {
  int dim = 2;                             // 2 or 3
  bool axisymmetric = false;               // dim 2: direction 0 is the radius
  bool floor = true;                       // no-slip wall at vertical 0, material above
  std::array<double, 3> period{0, 0, 0};   // > 0: periodic over [0, period) in that direction
  std::array<double, 3> gravity{0, 0, 0};  // m/s^2
  double spacing = 0;                      // dp, initial distance of particles, m
  Material material;
  Numerics numerics;
  laws::SphKernels::Any kernel;
  laws::ViscousOperators::Any viscous;
  laws::ViscosityMeans::Any mean;
  Stepping stepping = Stepping::minatti2015;

  double h() const { return numerics.smoothing_ratio * spacing; }
  int vertical() const { return dim - 1; }
  bool corrected() const {
    return std::visit([](const auto& v) { return std::decay_t<decltype(v)>::corrected; }, viscous);
  }
  double phi_max() const {
    return std::visit([](const auto& d) { return d.phi_max; }, material.dilatancy);
  }
  double phi_min() const {
    return std::visit([](const auto& d) { return d.phi_min; }, material.dilatancy);
  }
  double static_friction() const {
    return std::visit([](const auto& r) { return r.static_friction(); }, material.rheology);
  }
  // Shape of the yield surface where Lode angles differ; plane flow is plane strain, whatever it dilates.
  laws::YieldSurfaces::Any yield_surface() const {
    return dim == 3 || axisymmetric ? material.yield_surface : laws::YieldSurfaces::Any{};
  }
  bool lode_angles() const { return !std::holds_alternative<laws::yield_surface::DruckerPrager>(yield_surface()); }
  const laws::eos::CompressibleGrains& grains() const { return std::get<laws::eos::CompressibleGrains>(material.eos); }
  double sound_speed() const { return grains().sound_speed(phi_max()); }
  double gravity_norm() const {
    return std::sqrt(gravity[0] * gravity[0] + gravity[1] * gravity[1] + gravity[2] * gravity[2]);
  }
};

// Throws UnphysicalError when the choices do not fit together.
void check(const Model& model);

}  // namespace bagnold::sph

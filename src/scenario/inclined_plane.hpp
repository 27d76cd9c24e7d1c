// A uniform layer of continuum on an inclined plane, and what it must do.
#pragma once
#include <string_view>
#include <vector>

#include "sph/model.hpp"
#include "sph/state.hpp"

namespace bagnold::scenario {

// Periodic along the slope; x down the slope, z normal to it.
struct InclinedPlane {
  static constexpr std::string_view name = "inclined_plane";
  static constexpr std::string_view summary = "layer of continuum on an inclined plane, from rest";
  static constexpr std::string_view source = "Minatti & Paris 2015, section 5.1";
  double angle_deg = 25, height = 0.1, length = 0.1, spacing = 5e-3;
  static constexpr auto fields() {
    using S = InclinedPlane;
    return std::tuple{field("angle_deg", "deg", "slope", &S::angle_deg, closed(0, 89)),
                      field("height", "m", "thickness H of the steady flow", &S::height, positive()),
                      field("length", "m", "period along the slope", &S::length, positive()),
                      field("spacing", "m", "dp, distance of particles", &S::spacing, positive())};
  }
};

// Sets floor, period, gravity and spacing of the model.
void set_geometry(const InclinedPlane& plane, sph::Model& model);
// A lattice at rest, density in hydrostatic equilibrium. A layer that will flow dilates from phi_max to phi(i), so its
// rows start closer together by phi(i)/phi_max: H is the thickness of the flow, as in eq. 56.
sph::Particles make_particles(const InclinedPlane& plane, const sph::Model& model);

// Steady uniform flow of the mu(i) law                                          Minatti & Paris 2015, eq. 56
struct PlaneFlow {
  double i = 0, phi = 0;  // inertial number and volume fraction, uniform over depth; 0 and phi_max when at rest
  double height = 0, angle_deg = 0;
  double u_surface = 0;
  double velocity(double z) const;
  double pressure(double z, double grain_density) const;
};
// Throws UnphysicalError when the slope is steeper than mu_2 allows: no steady flow exists.
PlaneFlow steady_flow(const InclinedPlane& plane, const sph::Model& model);

// Flow from rest: rho du/dt = rho g sin(theta) + d tau/dz on `cells` cells, backward Euler, for the thickness `height`.
// Returns u at the cell centres at each of `times` (ascending). `constant_viscosity` is added to the one of the law, Pa s.
std::vector<std::vector<double>> transient_flow(const InclinedPlane& plane, const sph::Model& model, double height,
                                                int cells, const std::vector<double>& times,
                                                double constant_viscosity = 0);

}  // namespace bagnold::scenario

// Density rate, velocity gradient and what the neighbourhood looks like, from positions and velocities.
#pragma once
#include "sph/work.hpp"

namespace bagnold::sph {

// B is M^-1 above this smallest eigenvalue of M; below it is blended to 1, as the neighbourhood becomes too thin for an
// inverse to mean anything.
inline constexpr double blend_to = 0.5;

enum class Kinematics {
  density,    // density_rate only (first half of the midpoint step)
  pairs,      // density_rate and gradient as printed: eqs 26, 31
  corrected,  // M, B, L = S B, density_rate = -rho tr L; keeps the pairs' geometry
};
// Fills density_rate, shear_rate; `corrected` (and `pairs` with `moments`) also volume, area, coverage, concentration,
// imbalance.
void kinematics(Work& work, const Particles& particles, const Model& model, Kinematics what, bool moments = false);

// volume = m/rho of a changed rho. Areas stay: the forces of a step must see the gradients B was made for, or rotations
// would strain.
void update_volumes(Work& work, const Particles& particles);

// Whether rotation is told from strain (small_tensor.hpp): where B is not M^-1, but for a lone particle on the floor. With its
// image, which slides the other way, it would be a wheel, and no friction would ever stop it.
inline bool may_turn(const Work& work, const Particles& particles, const Model& model, std::size_t i) {
  constexpr double alone = 0.05;
  const bool low = model.floor && particles.x[static_cast<std::size_t>(model.vertical())][i] < model.h();
  return work.coverage[i] < blend_to && !(low && work.coverage[i] < alone);
}

// 1/r of an axisymmetric ring; particles on the axis count as a tenth of a spacing away from it.
inline double inverse_radius(const Model& model, double r) { return 1 / std::max(r, 0.1 * model.spacing); }

}  // namespace bagnold::sph

// Viscosity that belongs to the velocity at the end of the step.
#pragma once
#include "sph/work.hpp"

namespace bagnold::sph {

// Viscosity (and pair coefficients) of the velocities in `particles.v` at the pressures of the present step. Returns by how much
// the dissipation that was used differs from the law: sum V |eta_new - eta_old| gamma^2 over sum V eta_new gamma^2.
double reweigh_viscosity(Work& work, const Particles& particles, const Model& model);

}  // namespace bagnold::sph

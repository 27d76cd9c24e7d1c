// Pressure and viscosity from density and shear rate.
#pragma once
#include "sph/work.hpp"

namespace bagnold::sph {

// Cubic (44), p (41), tau_y (12), eta0 (47), regularised viscosity; keeps the root as the next start. Returns the
// largest eta/rho.
double constitutive(Work& work, Particles& particles, const Model& model);

// i = gamma d/sqrt(p/rho_s), with the grain size and density under pressure; 0 where p = 0 and nothing shears, infinite
// where p = 0 and something does.
double inertial_number(const Model& model, double shear_rate, double root);

}  // namespace bagnold::sph

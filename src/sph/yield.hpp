// Viscosity of another velocity than that of the beginning of the step.
#pragma once
#include "sph/work.hpp"

namespace bagnold::sph {

// Viscosity (shear and bulk) becomes that of velocities v, at the pressures of the present step, wherever that is less.
void lower_viscosity(Work& work, const Particles& particles, const Model& model, const Field& v);

}  // namespace bagnold::sph

// The time loop of the continuum model.
#pragma once
#include "sph/work.hpp"

namespace bagnold::sph {

// Makes a fresh state ready for its first step: neighbours, and the viscosity the first step size needs.
void initialise(State& state, Work& work, const Model& model);
// Rebuilds what is derived from a state read from a checkpoint.
void restore(State& state, Work& work, const Model& model);
// One step. Throws NumericalError.
void step(State& state, Work& work, const Model& model);
// Brings pressure, viscosity, shear rate and coverage in line with the present state without changing it: for output.
void refresh(const State& state, Work& work, const Model& model);

// Largest stable step (eq. 39; the implicit scheme is bound by sound and advection only).
double step_limit(const State& state, const Model& model);

}  // namespace bagnold::sph

// The time loop of the continuum model.
#pragma once
#include <limits>

#include "sph/work.hpp"

namespace bagnold::sph {

// Makes a fresh state ready for its first step: neighbours, and the viscosity the first step size needs.
void initialise(State& state, Work& work, const Model& model);
// Rebuilds what is derived from a state read from a checkpoint.
void restore(State& state, Work& work, const Model& model);
// One step; the last two before `end` share what is left, so that it is met exactly. Throws NumericalError.
void step(State& state, Work& work, const Model& model, double end = std::numeric_limits<double>::infinity());
// Brings pressure, viscosity, shear rate and coverage in line with the present state without changing it: for output.
void refresh(const State& state, Work& work, const Model& model);

// Largest stable step (eq. 39; the implicit scheme is bound by sound and advection only).
double step_limit(const State& state, const Model& model);

}  // namespace bagnold::sph

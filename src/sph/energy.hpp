// Where energy goes: entries in State::ledger, made by the time loop when it is kept. Costs one application of the viscous
// operator a step (the printed scheme: one or two more sweeps) and changes nothing else.
#pragma once
#include "sph/work.hpp"

namespace bagnold::sph {

// -sum m g.x, J (J/m planar). Means little where gravity points along a period.
double potential_energy(const State& state, const Model& model);
// Energy stored in squeezed grains: sum of Kt p^2/2 over their volume m/rho_s0, J; the relative error is Kt p.
double elastic_energy(const State& state, const Model& model);
// KE(0) + gravity - everything lost - KE now: zero but for rounding.
double ledger_residual(const State& state, const Model& model);

// sum p V (D rho/Dt)/rho, W, with the pressure of the last step: what density rates put into compression.
double compression_power(const Work& work, const Particles& particles, const Model& model);
// The same of densities that jumped from `before` to what they are, J.
double compression_work(const std::vector<double>& before, const Particles& particles, const Model& model);

// Before anything but forces has changed velocities, and at the end of the step.
void enter_forces(State& state, Work& work, const Model& model);
void enter_displacements(State& state, const Model& model);

// For the printed scheme: in the middle of the step, and at its end.
void separate_forces(Work& work, const Particles& particles, const Model& model);
void enter_printed_step(State& state, const Work& work, const Model& model);

}  // namespace bagnold::sph

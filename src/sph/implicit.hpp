// Backward Euler for viscosity.
#pragma once
#include "sph/work.hpp"

namespace bagnold::sph {

// Solves (m - dt A) v_new = m (v + dt acceleration) for frozen viscosity by conjugate gradients with block Jacobi
// preconditioning, started from v + dt rate. Writes v_new and rate = (v_new - v)/dt. Returns the iterations.
// Stops at |r| < cg_tolerance (sum m g^2 dt^2)^1/2 in the norm of the preconditioner.
// Throws NumericalError when it does not converge.
int solve_viscous(Work& work, State& state, const Model& model, double dt);

// force = A v for whichever operator the model has.
void viscous_force(Work& work, const Particles& particles, const Model& model, const Field& v, Field& force);

}  // namespace bagnold::sph

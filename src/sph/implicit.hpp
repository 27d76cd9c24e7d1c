// Backward Euler for viscosity.
#pragma once
#include "sph/work.hpp"

namespace bagnold::sph {

// Solves (m - dt A) v_new = m (v + dt acceleration) by conjugate gradients with block Jacobi preconditioning, started from
// v + dt rate, until r m^-1 r < cg_tolerance^2 sum m g^2 dt^2: the unbalanced acceleration, not the error of the velocity, which
// is tiny in material that does not yield even where it should. A frozen during a solve is the viscosity of v; it is taken again
// from v_new at most viscosity_rounds times, which lowers the convex functional of the nonlinear problem each time
// (eta falls with gamma). Writes v_new and rate = (v_new - v)/dt. Returns the iterations.
// Throws NumericalError when it does not converge.
int solve_viscous(Work& work, State& state, const Model& model, double dt);

// force = A v for whichever operator the model has.
void viscous_force(Work& work, const Particles& particles, const Model& model, const Field& v, Field& force);

}  // namespace bagnold::sph

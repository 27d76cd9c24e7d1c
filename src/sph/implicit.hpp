// Backward Euler for viscosity.
#pragma once
#include "sph/work.hpp"

namespace bagnold::sph {

// Lowers viscosity to that of v + dt rate = 2 v(n) - v(n-1), the velocity which the last acceleration leads to, where it is less.
// With that of v(n) alone, material beyond yield would speed up by tau/tau_y a step at most and start some ten steps late; with
// that of the expected velocity alone, material at rest would yield to every jitter. Variational operator.
void predict_viscosity(Work& work, const State& state, const Model& model, double dt);

// Solves (m - dt A) v_new = m (v + dt acceleration) by conjugate gradients with block Jacobi preconditioning, started from
// v + dt rate, until r m^-1 r < cg_tolerance^2 sum m g^2 dt^2: the unbalanced acceleration, not the error of the velocity, which
// is tiny in material that does not yield even where it should. The viscosity stays what it is. Writes v_new and
// rate = (v_new - v)/dt. Returns the iterations. Throws NumericalError when it does not converge.
int solve_viscous(Work& work, State& state, const Model& model, double dt);

// force = A v for whichever operator the model has.
void viscous_force(Work& work, const Particles& particles, const Model& model, const Field& v, Field& force);

}  // namespace bagnold::sph

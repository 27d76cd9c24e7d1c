// Pressure and viscous forces of both discretisations, behind one set of names.
#pragma once
#include "sph/work.hpp"

namespace bagnold::sph {

// acceleration = gravity + pressure (+ viscosity and artificial viscosity when `viscous`, minatti2015 operator only).
void pair_momentum_rate(Work& work, const Particles& particles, const Model& model, bool viscous);

// acceleration = gravity + pressure, the adjoint of the corrected divergence; also k and preconditioner.
// Needs kinematics(corrected) at the present positions.
void corrected_pressure_and_coefficients(Work& work, const Particles& particles, const Model& model);
// k and preconditioner of the pair operator.
void pair_coefficients(Work& work, const Particles& particles, const Model& model);

// force = A v: the viscous force [N] on every particle for velocities v, linear, symmetric, negative semi-definite.
void corrected_viscous_force(Work& work, const Particles& particles, const Model& model, const Field& v, Field& force);
// shear_rate of velocities v at the positions kinematics(corrected) saw.
void corrected_shear_rate(Work& work, const Particles& particles, const Model& model, const Field& v);
// What the law takes of velocities v, W: 2 eta e':e' and zeta (tr L)^2 over all volumes. Right after
// corrected_viscous_force(v).
struct LawDissipation {
  double friction = 0, bulk = 0;
  LawDissipation& operator+=(const LawDissipation& other) {
    friction += other.friction, bulk += other.bulk;
    return *this;
  }
};
LawDissipation corrected_dissipation(const Work& work, const Particles& particles, const Model& model, const Field& v);
void pair_viscous_force(Work& work, const Particles& particles, const Model& model, const Field& v, Field& force);

}  // namespace bagnold::sph

// The state of the continuum model: plain data. Everything that decides the next step is here.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/arrays.hpp"

namespace bagnold::sph {

// One array a component. Directions are (x, z) planar, (r, z) axisymmetric, (x, y, z) in 3D: the last is the vertical.
using Field = std::array<std::vector<double>, 3>;

struct Particles {
  Field x, v;                     // position, velocity at t
  Field rate;                     // Dv/Dt of the last step; explicit steps start from it
  Field x_built;                  // positions the neighbour list was built at: it decides when to build again
  double skin = 0;                // of that list, beyond 2h
  std::vector<double> rho, mass;  // bulk density; mass (per unit width planar, of the whole ring axisymmetric)
  std::vector<double> root;       // sqrt(rho_s* - 1), start of the next solution of the cubic
  std::vector<std::int64_t> id;   // survives reordering
  std::int64_t size() const { return static_cast<std::int64_t>(mass.size()); }
};

// Where energy went since t = 0, J (J/m planar). Kept only when asked for.
struct Ledger {
  double start = 0;       // kinetic energy at t = 0
  double gravity = 0;     // work of gravity
  double pressure = 0;    // work done against pressure: squeezes grains, or dilates and is lost
  double friction = 0;    // lost to the viscosity of the law
  double bulk = 0;        // lost to bulk viscosity
  double residual = 0;    // lost to the residual viscosity; printed operator: to its stress less that of the law
  double artificial = 0;  // lost to artificial viscosity
  double stepping = 0;    // lost to first order in time, viscosity of the wrong moment, an unfinished solution
  double walls = 0;       // kinetic energy taken by the base and by being put back
  double displaced = 0;   // potential energy gained by being moved: shifting, being put back
  double diffusion = 0;   // put into compression by density diffusion and volume correction; no part of the balance
  double kinetic = 0, height = 0;  // of the step under way: energies that forces alone would leave
};

struct State {
  Particles particles;
  bool keep_ledger = false;
  Ledger ledger;
  double time = 0;
  double dt = 0;                       // of the last step
  double max_kinematic_viscosity = 0;  // max eta/rho of the last step: the explicit viscous limit of the next
  std::int64_t step = 0;
  std::int64_t force_evaluations = 0;  // of the viscous force, on all particles: one an explicit step
};

// Visits every array of an exact checkpoint. Unused directions are empty.
std::vector<NamedArray> named_arrays(State& state);

// `count` particles at rest, every array of `dim` directions sized.
Particles make_particles(std::int64_t count, int dim);

}  // namespace bagnold::sph

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

struct State {
  Particles particles;
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

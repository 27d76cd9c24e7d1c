// What is measured on a state. Nothing here changes it; pressure and the like must be fresh (refresh()).
#pragma once
#include "core/mass_quantile.hpp"
#include "sph/work.hpp"

namespace bagnold::sph {

double kinetic_energy(const State& state, const Model& model);
std::array<double, 3> momentum(const State& state, const Model& model);
double total_mass(const State& state);
// Largest i over particles well inside the flow (coverage above 0.9): loose particles have no meaningful pressure.
double max_inertial_number(const State& state, const Work& work, const Model& model);

// How far the material reaches from the axis or the middle, particle radius dp/2 included.
struct Front {
  double connected = 0;  // of the largest group of particles linked over at most 1.6 dp
  double raw = 0;        // of the farthest particle
  double height = 0;     // of the connected group
  // Edge of the continuous layer: where, going outwards, the depth (volume of grains at phi_max over area, in rings of 2 dp,
  // both sides of a planar column together, linear in between) first falls below one grain, or below dp/2, one particle a
  // ring, if that is more.
  double layer = 0;
};
Front find_front(const State& state, const Work& work, const Model& model);
// Distances of the particles from the axis or the middle, to ask within which a share of the mass lies.
MassQuantiles radii(const State& state, const Model& model);

}  // namespace bagnold::sph

// Fields on a regular grid, interpolated from the particles.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "sph/work.hpp"

namespace bagnold::sph {

// Cubic cells of size dp whose corners lie on multiples of dp, around all particles. Direction 1 of a two-dimensional
// model has one cell. Cells without material (`filled` below 1/2) hold NaN.
struct GridFields {
  std::array<double, 3> origin{0, 0, 0};  // corner of the first cell, m
  std::array<std::int64_t, 3> cells{1, 1, 1};
  double spacing = 0;          // m
  std::vector<double> filled;  // sum A_j W at the middle of a cell: 1 inside, 1/2 at a free surface
  std::vector<double> pressure, density, viscosity, inertial_number, speed;
  Field velocity;
};

// sum A_j f_j W / sum A_j W at the middle of every cell, mirror particles under the floor and beyond the axis and
// periodic ones included; i from the interpolated shear rate and pressure. Fields of `work` must be fresh (refresh()).
// Throws NumericalError when particles are so far apart that the grid would exceed `most_cells`.
GridFields interpolate(const State& state, const Work& work, const Model& model, std::int64_t most_cells = 20'000'000);

}  // namespace bagnold::sph

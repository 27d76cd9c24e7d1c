// The state of the particle model: plain data. Everything that decides the next step is here; exact checkpoints
// store these arrays and nothing else (see visit_state).
#pragma once
#include <cstdint>
#include <vector>

#include "core/arrays.hpp"
#include "core/box.hpp"
#include "core/vec3.hpp"

namespace bagnold::dem {

// Spheres, one array per quantity. Grains [0, flowing) move; [flowing, size) are fixed (base): infinite mass, v = 0,
// omega = 0. `mass` and `inertia` of a fixed grain are those of its material; only the integrator ignores it.
struct Grains {
  std::vector<Vec3> x;                    // centres at t; periodic directions need not be wrapped
  std::vector<Vec3> v, omega;             // velocity, angular velocity at t - dt/2 (they enter the forces)
  std::vector<Vec3> force, torque;        // at t, gravity not included in `force`
  std::vector<double> diameter, mass, inertia;
  std::vector<std::int32_t> species;      // index into the contact model's species
  std::vector<std::int64_t> id;           // survives reordering; stable name of the grain in every output
  std::int64_t flowing = 0;
  std::int64_t size() const { return static_cast<std::int64_t>(x.size()); }
};

// An infinite frictional plane through `point`; grains are on the side `normal` points to (unit vector).
struct Wall {
  Vec3 point, normal;
  std::int32_t species = 0;
};

// One touching pair as observers see it: a pure function of the state (dem/contacts.hpp lists them on request).
struct Contact {
  std::int32_t i = 0;        // a flowing grain
  std::int32_t j = 0;        // another grain, or -1 - w for wall w
  Vec3 branch{};             // r_ij = x_i - x_j, minimum image; at a wall from the foot of the perpendicular to x_i
  Vec3 normal{};             // unit vector from j to i
  double overlap = 0;        // delta_n > 0
  Vec3 force{}, torque{};    // on i: force, and torque about x_i
  Vec3 torque_j{};           // on j about x_j
  Vec3 normal_force{};       // part of `force` along `normal`
  Vec3 spring{};             // tangential displacement delta_t
};

}  // namespace bagnold::dem

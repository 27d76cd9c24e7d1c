// What coarse-graining reads of one instant, wherever it comes from: a running engine, its file, another code's dump.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/box.hpp"
#include "core/vec3.hpp"
#include "dem/state.hpp"

namespace bagnold::cg {

// Grains [0, flowing) carry the fields; the others are base. All velocities at the same time as the positions.
struct Snapshot {
  double time = 0;
  Box box;  // averaged directions are divided by box.length, periodic or not
  std::span<const Vec3> x, v, omega;
  std::span<const double> diameter, mass, inertia;
  std::int64_t flowing = 0;
  std::span<const dem::Contact> contacts;  // every touching pair with a flowing grain, once; i flows
};

// A snapshot that owns its arrays: what the readers of files return.
struct StoredSnapshot {
  double time = 0;
  Box box;
  std::vector<Vec3> x, v, omega;
  std::vector<double> diameter, mass, inertia;
  std::int64_t flowing = 0;
  std::vector<dem::Contact> contacts;
  Snapshot view() const { return {time, box, x, v, omega, diameter, mass, inertia, flowing, contacts}; }
};

// True if the partner of the contact does not flow (a base grain or a wall): its force leaves the flowing system.
template <class Contact>
bool touches_base(std::int64_t flowing, const Contact& c) {
  return c.j < 0 || c.j >= flowing;
}
inline bool touches_base(const Snapshot& s, const dem::Contact& c) { return touches_base(s.flowing, c); }

// From the contact point to the centre of grain i: what a base contact spreads along, see cg/channels.hpp.
template <class Contact>
Vec3 arm_from_contact(double diameter, const Contact& c) {
  return (0.5 * (diameter - c.overlap)) * c.normal;
}
inline Vec3 arm_from_contact(const Snapshot& s, const dem::Contact& c) {
  return arm_from_contact(s.diameter[static_cast<std::size_t>(c.i)], c);
}

}  // namespace bagnold::cg

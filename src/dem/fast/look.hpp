// What an observer sees of the engine between two steps, without writing it back to the plain state. Grains are read
// from the rows themselves (engine.hpp, rows.hpp: velocities half a step behind, forces of the present positions).
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "dem/fast/rows.hpp"

namespace bagnold::dem::fast {

struct Engine;

// Eight pairs, lane by lane.
struct ContactPack {
  using Vector = std::array<std::array<double, 8>, 3>;
  alignas(64) Vector branch, normal, force;  // r_i - r_j; unit vector from j to i; force on i
  alignas(64) std::array<double, 8> overlap;
  std::array<std::uint32_t, 8> i, j;  // rows; either may be fixed
  std::uint32_t touching;             // bit k: lane k is a contact
};

// The contacts of a section; forces are those of the last evaluation, to round-off. Pairs apart may be among them.
// A few packs at a time, so that they need not leave the nearest cache: begins at pair `from` (0, then where the last call
// left it), fills `out` and returns how many packs it holds, 0 at the end.
std::size_t look_at_contacts(const Engine& engine, std::size_t section, std::size_t& from, std::span<ContactPack> out);

}  // namespace bagnold::dem::fast

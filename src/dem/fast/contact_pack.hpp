// What an observer sees of the contacts at a step, from the kernel that made their forces (dem::Watch). Grains are read from
// the rows themselves (engine.hpp, rows.hpp: velocities half a step behind, forces of the present positions).
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace bagnold::dem::fast {

struct Engine;

// Eight pairs, lane by lane; not all of them need to touch.
struct ContactPack {
  using Vector = std::array<std::array<double, 8>, 3>;
  alignas(64) Vector branch, normal, force;  // r_i - r_j; unit vector from j to i; force on i
  alignas(64) std::array<double, 8> overlap;
  std::array<std::uint32_t, 8> i, j;  // rows; either may be fixed
  std::uint32_t touching;             // bit k: lane k is a contact
};
using ContactPacks = std::span<const ContactPack>;

}  // namespace bagnold::dem::fast

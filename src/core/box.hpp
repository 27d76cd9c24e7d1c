// The periodic box: which directions repeat, and how far apart two points are in it.
#pragma once
#include <array>
#include <cmath>

#include "core/vec3.hpp"

namespace bagnold {

// [origin, origin + length) in each direction. A direction that is not periodic is unbounded: walls, if any,
// are separate objects.
struct Box {
  Vec3 origin{};
  Vec3 length{1, 1, 1};
  std::array<bool, 3> periodic{false, false, false};
};

// Shortest of the periodic images of the separation `d`.
inline Vec3 minimum_image(const Box& box, Vec3 d) {
  for (int k = 0; k < 3; ++k)
    if (box.periodic[static_cast<std::size_t>(k)]) d[k] -= box.length[k] * std::nearbyint(d[k] / box.length[k]);
  return d;
}

// The image of `r` inside the box (periodic directions only).
inline Vec3 wrap(const Box& box, Vec3 r) {
  for (int k = 0; k < 3; ++k) {
    if (!box.periodic[static_cast<std::size_t>(k)]) continue;
    if (r[k] >= box.origin[k] && r[k] < box.origin[k] + box.length[k]) continue;
    r[k] -= box.length[k] * std::floor((r[k] - box.origin[k]) / box.length[k]);
    if (r[k] >= box.origin[k] + box.length[k]) r[k] = box.origin[k];  // floor of a tiny negative rounds up
  }
  return r;
}

}  // namespace bagnold

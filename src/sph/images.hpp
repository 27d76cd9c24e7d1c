// Image particles: copies of particles near a periodic face, the floor or the axis, so that no pair loop knows of any.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "sph/model.hpp"
#include "sph/state.hpp"

namespace bagnold::sph {

// Image k: position R x + shift and velocity S v of its parent, with R, S diagonal signs. Tensors that turn a
// separation into a force go as S T R. Periodic: R = S = 1. Axis: R = S = -1 for the radius. No-slip floor: R = -1 for
// the vertical, S = -1 for all.
struct Images {
  std::vector<std::int32_t> parent;
  std::vector<std::array<double, 3>> R, S, shift;
  std::int64_t size() const { return static_cast<std::int64_t>(parent.size()); }
};

// Images of all particles within `reach` of a face. The floor has images only for the corrected (variational) operator;
// the other one uses Morris ghosts.
Images make_images(const Model& model, const Particles& particles, double reach);

}  // namespace bagnold::sph

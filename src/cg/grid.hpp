// Direct evaluation of the coarse-graining sums on a grid that resolves any of the directions: z profiles, x-z planes,
// full 3D. Plain and general; depth profiles of long series go through cg/moments.hpp, which this is the check of.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "cg/channels.hpp"
#include "cg/snapshot.hpp"
#include "laws/registries.hpp"

namespace bagnold::cg {

// Nodes origin + (i, j, k) spacing in the resolved directions; the others are averaged over box.length. z is resolved.
struct Grid {
  std::array<bool, 3> resolved{false, false, true};
  std::array<std::int64_t, 3> count{1, 1, 1};
  Vec3 origin{}, spacing{1, 1, 1};

  int dimension() const { return resolved[0] + resolved[1] + resolved[2]; }
  std::int64_t size() const { return count[0] * count[1] * count[2]; }
  // Nodes are stored with x running fastest.
  Vec3 node(std::int64_t n) const {
    const std::int64_t i = n % count[0], j = n / count[0] % count[1], k = n / (count[0] * count[1]);
    return {origin.x + static_cast<double>(i) * spacing.x, origin.y + static_cast<double>(j) * spacing.y,
            origin.z + static_cast<double>(k) * spacing.z};
  }
};

// A grid that covers the box in the resolved periodic directions and [z_min, z_max], with steps of at most `spacing`.
Grid make_grid(const Box& box, std::array<bool, 3> resolved, double z_min, double z_max, double spacing);

// Adds the sums of one instant to `sums` (one row a node). Images in resolved periodic directions are included.
// The result does not depend on the number of threads. Throws UnphysicalError if the grid does not resolve z.
void add_snapshot(std::vector<Row>& sums, const Grid& grid, const laws::CgKernels::Any& kernel,
                  const Snapshot& snapshot);

// Gradients of mass and momentum density by fourth-order differences (second order in the two rows at an open edge),
// across the seam where the grid covers a whole period.
struct Gradient {
  std::array<std::array<double, 4>, 3> d{};  // d[direction][channel] of kMomentum and kMass
};
std::vector<Gradient> gradients(const std::vector<Row>& rows, const Grid& grid, const Box& box);

}  // namespace bagnold::cg

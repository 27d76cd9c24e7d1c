// Random filling with a growing insertion height (Weinhart et al. 2012, section 5): each sphere tries uniform random
// points of a region of height I; an attempt that overlaps anything is rejected and I grows a little. The initial
// packing is about 0.3, loose enough to fall and start to flow.
#pragma once
#include <cstdint>
#include <vector>

#include "core/box.hpp"
#include "core/random.hpp"

namespace bagnold::scenario {

struct Sphere {
  Vec3 x;
  double diameter = 1;
};

struct FillRegion {
  Box box;                     // footprint [origin, origin + length) in x and y
  double floor = 0;            // lowest centre
  bool solid_floor = false;    // spheres stay above the floor by their radius
  double height = 1;           // insertion height I at the start
  double growth = 1e-4;        // what a rejected attempt adds to I
  double cylinder_radius = 0;  // > 0: spheres stay inside this vertical cylinder about the middle of the footprint
};

// Centres of spheres of the given diameters, placed one after the other, clear of each other and of `obstacles`.
// Random numbers are keyed by (seed, stream, index of the sphere, attempt): the result depends on nothing else.
std::vector<Vec3> fill(const FillRegion& region, const std::vector<double>& diameters,
                       const std::vector<Sphere>& obstacles, std::uint64_t seed, random::Stream stream);

}  // namespace bagnold::scenario

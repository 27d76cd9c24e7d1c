// A static bed: grains inserted at random into a periodic box with a flat frictional bottom, left to come to rest.
// Rough bases and columns are cut from it.
#pragma once
#include <cstdint>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/fields.hpp"
#include "core/vec3.hpp"

namespace bagnold::scenario {

// Lengths in mean diameters, times in sqrt(d/g). The bed depends on these numbers alone, so it can be kept and reused.
struct BedRecipe {
  double length = 20, width = 10;  // periodic footprint
  double thickness = 12;           // of the settled bed, about
  double size_spread = 0;          // diameters uniform in 1 -+ spread
  double friction = 0.5, restitution = 0.88;
  // Grains here are softer than those that flow: at rest the overlaps are still below 1e-3 diameters, and the bed
  // settles in a tenth of the steps.
  double collision_time = 0.02;
  std::int64_t seed = 1;
  static constexpr auto fields() {
    return std::tuple{field("length", "d", "", &BedRecipe::length),
                      field("width", "d", "", &BedRecipe::width),
                      field("thickness", "d", "", &BedRecipe::thickness),
                      field("size_spread", "", "", &BedRecipe::size_spread),
                      field("friction", "", "", &BedRecipe::friction),
                      field("restitution", "", "", &BedRecipe::restitution),
                      field("collision_time", "", "", &BedRecipe::collision_time),
                      field("seed", "", "", &BedRecipe::seed)};
  }
};

struct Bed {
  std::vector<Vec3> x;  // centres, bottom plane at z = 0
  std::vector<double> diameter;
};

// Height [d] of the loose filling, one grain per d^3, that settles to the thickness asked for.
double filling_height(const BedRecipe& recipe);

// At rest means E_kin < 1e-5 E_ela (Weinhart et al. 2012, section 6), or after a long time E_kin < 1e-6 m g d a grain. Throws NumericalError if the bed does not settle.
Bed settle_bed(const BedRecipe& recipe);

// The rough base: grains with centres in z in [9.3, 11], shifted down by 11 (Weinhart et al. 2012, section 5).
// Still in units of the base's own diameter; the highest centres lie just below z = 0.
std::vector<Vec3> cut_base(const Bed& bed);
inline constexpr double base_bed_thickness = 12;

}  // namespace bagnold::scenario

// A static bed: grains inserted at random into a periodic box with a flat frictional bottom, left to come to rest.
// Rough bases and columns are cut from it.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/fields.hpp"
#include "core/vec3.hpp"

namespace bagnold::scenario {

// Lengths in mean diameters d, times in sqrt(d/g), masses in those of a grain of diameter d. The bed depends on these
// numbers alone, so it can be kept and reused.
struct BedRecipe {
  double length = 20, width = 10;  // periodic footprint
  double thickness = 12;           // of the settled bed, about
  double size_spread = 0;          // diameters uniform in 1 -+ spread
  double friction = 0.5;
  // Two grains of diameter d rebound with eps = 0.88 after tc = 0.02. They are softer than those that flow: at rest the
  // overlaps are still below 1e-3 diameters, and the bed settles in a tenth of the steps. Numbers, not (tc, eps): a
  // logarithm is not the same on every machine.
  double stiffness = 12357.4, damping = 6.3917;
  double step = 0.001;  // tc/20, for what matters is where grains come to rest, not how; shorter if some are lighter
  std::int64_t seed = 1;
  static constexpr auto fields() {
    return std::tuple{field("length", "d", "", &BedRecipe::length),
                      field("width", "d", "", &BedRecipe::width),
                      field("thickness", "d", "", &BedRecipe::thickness),
                      field("size_spread", "", "", &BedRecipe::size_spread),
                      field("friction", "", "", &BedRecipe::friction),
                      field("stiffness", "", "", &BedRecipe::stiffness),
                      field("damping", "", "", &BedRecipe::damping),
                      field("step", "", "", &BedRecipe::step),
                      field("seed", "", "", &BedRecipe::seed)};
  }
  bool operator==(const BedRecipe&) const = default;
};

struct Bed {
  std::vector<Vec3> x;  // centres, bottom plane at z = 0
  std::vector<double> diameter;
};

// What computes beds. A bed of another origin has other bits, so it is stored with this name and only used under it.
// Change it when settle_bed gives other bits for the same recipe.
//
// The bits depend on neither machine nor compiler options nor threads: from the random numbers to the grains at rest
// there are only + - * / sqrt of IEEE 754, no function of the mathematical library, and no fused multiply-add.
std::string_view bed_path();

std::int64_t bed_grains(const BedRecipe& recipe);
double bed_steps(const BedRecipe& recipe);  // that settling takes, about

// Where a bed is on its way to rest.
struct Settling {
  std::int64_t step;
  double time, latest;  // now, and when settling is given up
  double energy_ratio;  // E_kin/E_ela, at rest below 1e-5
};
// Called some times a second; false: stop.
using SettlingWatch = std::function<bool(const Settling&)>;

// At rest means E_kin < 1e-5 E_ela (Weinhart et al. 2012, section 6), or after a long time E_kin < 1e-6 m g d a grain.
// Throws NumericalError if the bed does not settle. Nothing if the watch stopped it.
std::optional<Bed> settle_bed(const BedRecipe& recipe, const SettlingWatch& watch = {});

// As many grains of the same sizes in about the same space, put there at random: what can be counted in a bed without
// settling it. They overlap; nothing can be run from it. Throws UnphysicalError for a recipe that makes no bed.
Bed stand_in_bed(const BedRecipe& recipe);

// The rough base: grains with centres in z in [9.3, 11], shifted down by 11 (Weinhart et al. 2012, section 5).
// Still in units of the base's own diameter; the highest centres lie just below z = 0.
std::vector<Vec3> cut_base(const Bed& bed);
inline constexpr double base_bed_thickness = 12;

}  // namespace bagnold::scenario

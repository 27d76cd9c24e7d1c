// Initial states of the particle model. Each scenario is its own keys and one function that builds a state.
#pragma once
#include <cstdint>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/constants.hpp"
#include "core/fields.hpp"
#include "dem/state.hpp"
#include "scenario/settled_bed.hpp"

namespace bagnold::scenario {

// Species of every granular scenario: what flows, and what the base or the walls are made of.
inline constexpr std::int32_t grain_species = 0, base_species = 1;

struct GrainMaterial {
  static constexpr std::string_view name = "grains";
  static constexpr std::string_view summary = "size and density of the flowing grains";
  double diameter = 1, density = 1.909859317102744, size_spread = 0;
  static constexpr auto fields() {
    return std::tuple{
        field("diameter", "length", "mean diameter d", &GrainMaterial::diameter, positive()),
        field("density", "mass/length^3", "of the grains' material; the default 6/pi gives m = 1 at d = 1",
              &GrainMaterial::density, positive()),
        field("size_spread", "-", "diameters are uniform in d (1 -+ spread)", &GrainMaterial::size_spread,
              Range{.lo = 0, .hi = 0.9})};
  }
};

struct Chute {
  static constexpr std::string_view name = "chute";
  static constexpr std::string_view summary = "periodic chute over a base of fixed grains or a flat plane";
  static constexpr std::string_view source = "Weinhart et al. 2012, section 5";
  double angle_deg = 24, length = 20, width = 10, fill_height = 20, base_size_ratio = 1, gravity = 1;
  // The paper's text says 0.01 d, which leaves a packing of 0.12; its "about 0.3" needs a hundredth of that.
  double insertion_growth = 1e-4;
  static constexpr auto fields() {
    return std::tuple{required("angle_deg", "deg", "inclination theta; gravity is g (sin theta, 0, -cos theta)",
                               &Chute::angle_deg, Range{.lo = 0, .hi = 90, .hi_open = true}),
                      required("length", "length", "periodic, downslope", &Chute::length, positive()),
                      required("width", "length", "periodic, across", &Chute::width, positive()),
                      required("fill_height", "length", "H: length * width * H / d^3 grains are inserted",
                               &Chute::fill_height, positive()),
                      field("base_size_ratio", "-", "lambda: diameter of base grains / d; 0 is a flat plane",
                            &Chute::base_size_ratio, closed(0, 4)),
                      field("gravity", "length/time^2", "g", &Chute::gravity, positive()),
                      field("insertion_growth", "d",
                            "what a rejected attempt adds to the insertion height; 1e-4 gives a packing of 0.3",
                            &Chute::insertion_growth, positive())};
  }
};

// A finite mass let go on a slope, the particle twin of a release of the shallow-layer model.
struct Avalanche {
  static constexpr std::string_view name = "avalanche";
  static constexpr std::string_view summary =
      "a pile of settled grains let go on a rough incline, periodic across the slope";
  static constexpr std::string_view source = "Weinhart et al. 2012, section 5, for the base and the grains";
  double angle_deg = 0, length = 0, width = 0, height = 0, extent = 0, centre = 0, base_size_ratio = 1, gravity = 1;
  static constexpr auto fields() {
    using S = Avalanche;
    return std::tuple{
        required("angle_deg", "deg", "inclination theta; gravity is g (sin theta, 0, -cos theta)", &S::angle_deg,
                 Range{.lo = 0, .hi = 90, .hi_open = true}),
        required("length", "length",
                 "of the plane, rounded up to whole patches of base; what leaves it below comes in again above",
                 &S::length, positive()),
        required("width", "length", "periodic, across", &S::width, positive()),
        required("height", "length", "H: the pile is H (1 - (2 (x - centre)/extent)^2) thick", &S::height, positive()),
        required("extent", "length", "of the pile, downslope", &S::extent, positive()),
        required("centre", "length", "x of the middle of the pile", &S::centre, positive()),
        field("base_size_ratio", "-", "lambda: diameter of base grains / d; 0 is a flat plane", &S::base_size_ratio,
              closed(0, 4)),
        field("gravity", "length/time^2", "g", &S::gravity, positive())};
  }
};

struct Column {
  static constexpr std::string_view name = "column";
  static constexpr std::string_view summary = "cylindrical column of settled grains released on a rough plane";
  static constexpr std::string_view source = "Lube et al. 2004; Lajeunesse et al. 2004";
  double radius = 0, height = 0, length = 0, base_size_ratio = 1, gravity = earth_gravity;
  static constexpr auto fields() {
    return std::tuple{required("radius", "length", "r0 of the column", &Column::radius, positive()),
                      required("height", "length", "H0 of the column", &Column::height, positive()),
                      required("length", "length", "side of the square plane, rounded up to whole patches of base",
                               &Column::length, positive()),
                      field("base_size_ratio", "-", "diameter of base grains / d; 0 is a flat plane",
                            &Column::base_size_ratio, closed(0, 4)),
                      field("gravity", "length/time^2", "g", &Column::gravity, positive())};
  }
};

struct Heap {
  static constexpr std::string_view name = "heap";
  static constexpr std::string_view summary = "loose grains fall onto a rough plane and form a heap";
  static constexpr std::string_view source = "Zhou et al. 2002 (angle of repose)";
  std::int64_t grains = 1000;
  double radius = 0, length = 0, drop_height = 0, base_size_ratio = 1, gravity = earth_gravity;
  static constexpr auto fields() {
    return std::tuple{
        required("grains", "-", "how many", &Heap::grains, at_least(1)),
        required("radius", "length", "of the cylinder the grains start in", &Heap::radius, positive()),
        required("length", "length", "side of the square plane, rounded up to whole patches of base", &Heap::length,
                 positive()),
        field("drop_height", "length", "lowest start above the plane", &Heap::drop_height, non_negative()),
        field("base_size_ratio", "-", "diameter of base grains / d; 0 is a flat plane", &Heap::base_size_ratio,
              closed(0, 4)),
        field("gravity", "length/time^2", "g", &Heap::gravity, positive())};
  }
};

// One grain or plane of the scenario "grains".
struct SingleGrain {
  static constexpr std::string_view name = "scenario.grains";
  Vec3 position, velocity, spin;
  std::optional<double> diameter;
  bool fixed = false;
  static constexpr auto fields() {
    return std::tuple{required("position", "length", "centre", &SingleGrain::position),
                      field("velocity", "length/time", "", &SingleGrain::velocity),
                      field("spin", "1/time", "angular velocity", &SingleGrain::spin),
                      field("diameter", "length", "auto: grains.diameter", &SingleGrain::diameter, positive()),
                      field("fixed", "-", "infinite mass, never moves", &SingleGrain::fixed)};
  }
};
struct SingleWall {
  static constexpr std::string_view name = "scenario.walls";
  Vec3 point, normal{0, 0, 1};
  static constexpr auto fields() {
    return std::tuple{required("point", "length", "a point of the plane", &SingleWall::point),
                      required("normal", "-", "towards the grains", &SingleWall::normal)};
  }
};
struct Singles {
  static constexpr std::string_view name = "grains";
  static constexpr std::string_view summary = "grains and planes one by one, for collisions and tests of a law";
  static constexpr std::string_view source = "Weinhart et al. 2012, figure 15";
  Vec3 gravity;
  std::vector<double> period;
  static constexpr auto fields() {
    return std::tuple{
        field("gravity", "length/time^2", "vector", &Singles::gravity),
        field("period", "length", "periods in x, y, z; 0 is not periodic", &Singles::period, non_negative())};
  }
};

// What a bed must be like for a scenario: the base grains, and the column. Both empty beds for a flat plane.
BedRecipe base_recipe(double length, double width, double base_diameter, std::uint64_t seed);
BedRecipe column_recipe(const Column& column, const GrainMaterial& material, std::uint64_t seed);
BedRecipe avalanche_recipe(const Avalanche& avalanche, const GrainMaterial& material, std::uint64_t seed);
// Side of the patch that tiles the plane of a column or heap, length of that of an avalanche, in base diameters.
inline constexpr double base_patch = 10, avalanche_patch = 20;

std::int64_t grain_count(const Chute& chute, double d);
std::vector<double> draw_diameters(std::int64_t count, const GrainMaterial& material, std::uint64_t seed);

// What can be said before a bed is settled. Throw UnphysicalError for an empty fill or a box too small for its grains.
void check(const Chute& chute, const GrainMaterial& material);
void check(const Avalanche& avalanche, const GrainMaterial& material);
void check(const Column& column, const GrainMaterial& material);
void check(const Heap& heap, const GrainMaterial& material);

// Builders. `base`: centres of base grains in their own diameters (cut_base), ignored for base_size_ratio = 0.
// Throw UnphysicalError like check(), which they call.
dem::DemState make_chute(const Chute& chute, const GrainMaterial& material, const std::vector<Vec3>& base,
                         std::uint64_t seed);
dem::DemState make_column(const Column& column, const GrainMaterial& material, const std::vector<Vec3>& patch,
                          const Bed& bed);
dem::DemState make_avalanche(const Avalanche& avalanche, const GrainMaterial& material, const std::vector<Vec3>& patch,
                             const Bed& bed);
dem::DemState make_heap(const Heap& heap, const GrainMaterial& material, const std::vector<Vec3>& patch,
                        std::uint64_t seed);
dem::DemState make_singles(const Singles& singles, const std::vector<SingleGrain>& grains,
                           const std::vector<SingleWall>& walls, const GrainMaterial& material);

}  // namespace bagnold::scenario

#include "scenario/granular.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/random.hpp"
#include "scenario/fill.hpp"

namespace bagnold::scenario {

namespace {

void add_grain(dem::Grains& grains, const Vec3& x, double diameter, double density, std::int32_t species) {
  const double mass = density * std::numbers::pi / 6 * diameter * diameter * diameter;
  grains.id.push_back(grains.size());
  grains.x.push_back(x);
  grains.v.push_back({});
  grains.omega.push_back({});
  grains.force.push_back({});
  grains.torque.push_back({});
  grains.diameter.push_back(diameter);
  grains.mass.push_back(mass);
  grains.inertia.push_back(0.1 * mass * diameter * diameter);  // solid sphere: m d^2/10
  grains.species.push_back(species);
  if (species == grain_species) ++grains.flowing;  // flowing grains are added first
}

// The base below z = 0: copies of a periodic patch of base grains side by side, or a plane.
void add_base(dem::DemState& state, const std::vector<Vec3>& patch, double diameter, double density, int nx, int ny,
              const Vec3& patch_size) {
  if (diameter == 0) {
    state.walls.push_back({{0, 0, 0}, {0, 0, 1}, base_species});
    return;
  }
  for (int ix = 0; ix < nx; ++ix)
    for (int iy = 0; iy < ny; ++iy)
      for (const Vec3& x : patch)
        add_grain(state.grains, state.box.origin + Vec3{ix * patch_size.x, iy * patch_size.y, 0} + diameter * x,
                  diameter, density, base_species);
}

std::vector<Sphere> base_spheres(const dem::Grains& grains) {
  std::vector<Sphere> out;
  for (std::size_t i = 0; i < grains.x.size(); ++i) out.push_back({grains.x[i], grains.diameter[i]});
  return out;
}

// Puts the flowing grains before the base that was built first.
dem::DemState with_flowing(dem::DemState state, const std::vector<Vec3>& x, const std::vector<double>& diameters,
                           double density) {
  const dem::Grains base = std::move(state.grains);
  state.grains = {};
  for (std::size_t i = 0; i < x.size(); ++i) add_grain(state.grains, x[i], diameters[i], density, grain_species);
  for (std::size_t i = 0; i < base.x.size(); ++i)
    add_grain(state.grains, base.x[i], base.diameter[i], density, base_species);
  return state;
}

// The square plane of a column or heap about the origin, and its base.
dem::DemState make_plane(double length, double base_diameter, double density, const std::vector<Vec3>& patch) {
  dem::DemState state;
  double side = length;
  int tiles = 1;
  if (base_diameter > 0) {
    tiles = std::max(1, static_cast<int>(std::ceil(length / (base_patch * base_diameter) - 1e-9)));
    side = tiles * (base_patch * base_diameter);
  }
  state.box = {{-0.5 * side, -0.5 * side, 0}, {side, side, side}, {true, true, false}};
  const double tile = base_patch * base_diameter;
  add_base(state, patch, base_diameter, density, tiles, tiles, {tile, tile, 0});
  return state;
}

}  // namespace

std::vector<double> draw_diameters(std::int64_t count, const GrainMaterial& material, std::uint64_t seed) {
  std::vector<double> diameters(static_cast<std::size_t>(count), material.diameter);
  if (material.size_spread > 0)
    for (std::size_t i = 0; i < diameters.size(); ++i)
      diameters[i] *= 1 + material.size_spread * (2 * random::uniform(seed, random::Stream::sizes, i) - 1);
  return diameters;
}

BedRecipe base_recipe(double length, double width, double base_diameter, std::uint64_t seed) {
  BedRecipe recipe;
  recipe.length = length / base_diameter;
  recipe.width = width / base_diameter;
  recipe.thickness = base_bed_thickness;
  recipe.seed = static_cast<std::int64_t>(seed);
  return recipe;
}

BedRecipe column_recipe(const Column& column, const GrainMaterial& material, std::uint64_t seed) {
  BedRecipe recipe;
  recipe.length = recipe.width = 2 * column.radius / material.diameter + 2;
  recipe.thickness = column.height / material.diameter + 1;
  recipe.size_spread = material.size_spread;
  recipe.seed = static_cast<std::int64_t>(seed);
  return recipe;
}

BedRecipe avalanche_recipe(const Avalanche& avalanche, const GrainMaterial& material, std::uint64_t seed) {
  const double d = material.diameter;
  BedRecipe recipe;
  recipe.length = avalanche.extent / d;
  recipe.width = avalanche.width / d;
  recipe.thickness = avalanche.height / d + 1;
  recipe.size_spread = material.size_spread;
  recipe.seed = static_cast<std::int64_t>(seed);
  return recipe;
}

std::int64_t grain_count(const Chute& chute, double d) {
  return std::llrint((chute.length / d) * (chute.width / d) * (chute.fill_height / d));
}

void check(const Chute& chute, const GrainMaterial& material) {
  const double d = material.diameter, largest = d * std::max(1 + material.size_spread, chute.base_size_ratio);
  for (const auto& [key, value] :
       {std::pair{"scenario.length", chute.length}, std::pair{"scenario.width", chute.width}})
    if (value < 2 * largest)
      throw UnphysicalError(
          key,
          "a periodic box must be at least two diameters of the largest grain wide, or a grain meets its own image");
  if (grain_count(chute, d) < 1)
    throw UnphysicalError("scenario.fill_height", "no grains: length * width * fill_height / d^3 rounds to 0");
}

dem::DemState make_chute(const Chute& chute, const GrainMaterial& material, const std::vector<Vec3>& base,
                         std::uint64_t seed) {
  check(chute, material);
  const double d = material.diameter;
  dem::DemState state;
  const double theta = chute.angle_deg * std::numbers::pi / 180;
  state.gravity = chute.gravity * Vec3{std::sin(theta), 0, -std::cos(theta)};
  state.box = {{0, 0, 0}, {chute.length, chute.width, chute.fill_height}, {true, true, false}};
  add_base(state, base, chute.base_size_ratio * d, material.density, 1, 1, {});

  const std::vector<double> diameters = draw_diameters(grain_count(chute, d), material, seed);
  FillRegion region{.box = state.box,
                    .solid_floor = chute.base_size_ratio == 0,
                    .height = chute.fill_height,
                    .growth = chute.insertion_growth * d};
  const auto x = fill(region, diameters, base_spheres(state.grains), seed, random::Stream::fill);
  return with_flowing(std::move(state), x, diameters, material.density);
}

void check(const Column& column, const GrainMaterial& material) {
  if (column.length < 2.5 * column.radius)
    throw UnphysicalError("scenario.length",
                          "the plane must be wider than the column by some run-out, expected at least 2.5 radius");
  if (2 * column.radius < material.diameter)
    throw UnphysicalError("scenario.radius", "no grains: the column is narrower than a grain");
}

dem::DemState make_column(const Column& column, const GrainMaterial& material, const std::vector<Vec3>& patch,
                          const Bed& bed) {
  check(column, material);
  const double d = material.diameter;
  dem::DemState state = make_plane(column.length, column.base_size_ratio * d, material.density, patch);
  state.gravity = {0, 0, -column.gravity};

  std::vector<Vec3> x;
  std::vector<double> diameters;
  const double middle = column.radius / d + 1;
  for (std::size_t i = 0; i < bed.x.size(); ++i) {
    Vec3 r = d * (bed.x[i] - Vec3{middle, middle, 0});
    const double size = d * bed.diameter[i];
    if (std::hypot(r.x, r.y) > column.radius - 0.5 * size || r.z > column.height - 0.5 * size) continue;
    r.z += column.base_size_ratio > 0 ? 0.5 * column.base_size_ratio * d : 0;  // clear of the tops of the base grains
    x.push_back(r);
    diameters.push_back(size);
  }
  if (x.empty()) throw UnphysicalError("scenario.radius", "no grains: the column is smaller than a grain");
  return with_flowing(std::move(state), x, diameters, material.density);
}

void check(const Avalanche& avalanche, const GrainMaterial& material) {
  const double largest = material.diameter * std::max(1 + material.size_spread, avalanche.base_size_ratio);
  if (avalanche.width < 2 * largest)
    throw UnphysicalError(
        "scenario.width",
        "a periodic box must be at least two diameters of the largest grain wide, or a grain meets its own image");
  const double half = 0.5 * avalanche.extent;
  if (avalanche.centre < half || avalanche.centre + half > avalanche.length)
    throw UnphysicalError("scenario.centre", "the pile, centre -+ extent/2, must lie on the plane, 0 to length");
}

dem::DemState make_avalanche(const Avalanche& avalanche, const GrainMaterial& material, const std::vector<Vec3>& patch,
                             const Bed& bed) {
  check(avalanche, material);
  const double d = material.diameter, base = avalanche.base_size_ratio * d;
  const double theta = avalanche.angle_deg * std::numbers::pi / 180;
  dem::DemState state;
  state.gravity = avalanche.gravity * Vec3{std::sin(theta), 0, -std::cos(theta)};
  const double tile = base > 0 ? avalanche_patch * base : avalanche.length;
  const int tiles = std::max(1, static_cast<int>(std::ceil(avalanche.length / tile - 1e-9)));
  state.box = {{0, 0, 0}, {tiles * tile, avalanche.width, avalanche.height}, {true, true, false}};
  add_base(state, patch, base, material.density, tiles, 1, {tile, avalanche.width, 0});

  std::vector<Vec3> x;
  std::vector<double> diameters;
  for (std::size_t i = 0; i < bed.x.size(); ++i) {
    Vec3 r = d * bed.x[i];
    const double s = 2 * r.x / avalanche.extent - 1, size = d * bed.diameter[i];
    if (r.z > avalanche.height * (1 - s * s)) continue;
    r.x += avalanche.centre - 0.5 * avalanche.extent;
    r.z += 0.5 * base;  // clear of the tops of the base grains
    x.push_back(r);
    diameters.push_back(size);
  }
  if (x.empty()) throw UnphysicalError("scenario.height", "no grains: the pile is smaller than a grain");
  return with_flowing(std::move(state), x, diameters, material.density);
}

void check(const Heap& heap, const GrainMaterial& material) {
  if (heap.length < 2.5 * heap.radius)
    throw UnphysicalError("scenario.length", "the plane must be wider than the heap, expected at least 2.5 radius");
  if (2 * heap.radius < material.diameter * (1 + material.size_spread))
    throw UnphysicalError("scenario.radius", "the cylinder is narrower than a grain");
}

dem::DemState make_heap(const Heap& heap, const GrainMaterial& material, const std::vector<Vec3>& patch,
                        std::uint64_t seed) {
  check(heap, material);
  const double d = material.diameter;
  dem::DemState state = make_plane(heap.length, heap.base_size_ratio * d, material.density, patch);
  state.gravity = {0, 0, -heap.gravity};
  const std::vector<double> diameters = draw_diameters(heap.grains, material, seed);
  FillRegion region{.box = state.box,
                    .floor = heap.drop_height,
                    .solid_floor = heap.base_size_ratio == 0,
                    .height = heap.radius,
                    .growth = 1e-4 * d,
                    .cylinder_radius = heap.radius};
  const auto x = fill(region, diameters, base_spheres(state.grains), seed, random::Stream::fill);
  return with_flowing(std::move(state), x, diameters, material.density);
}

dem::DemState make_singles(const Singles& singles, const std::vector<SingleGrain>& grains,
                           const std::vector<SingleWall>& walls, const GrainMaterial& material) {
  dem::DemState state;
  state.gravity = singles.gravity;
  state.box.length = {1, 1, 1};
  for (int k = 0; k < 3 && k < static_cast<int>(singles.period.size()); ++k) {
    const double period = singles.period[static_cast<std::size_t>(k)];
    if (period > 0) {
      state.box.length[k] = period;
      state.box.periodic[static_cast<std::size_t>(k)] = true;
    }
  }
  for (const bool fixed : {false, true})
    for (const SingleGrain& g : grains)
      if (g.fixed == fixed) {
        add_grain(state.grains, g.position, g.diameter.value_or(material.diameter), material.density,
                  fixed ? base_species : grain_species);
        if (!fixed) {
          state.grains.v.back() = g.velocity;
          state.grains.omega.back() = g.spin;
        }
      }
  if (state.grains.flowing == 0) throw UnphysicalError("scenario.grains", "no grains that can move");
  for (const SingleWall& w : walls) {
    if (norm(w.normal) == 0) throw UnphysicalError("scenario.walls", "the normal of a wall is zero");
    state.walls.push_back({w.point, w.normal / norm(w.normal), base_species});
  }
  return state;
}

}  // namespace bagnold::scenario

#include "scenario/settled_bed.hpp"

#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "dem/algorithm.hpp"
#include "dem/energy.hpp"
#include "scenario/granular.hpp"

namespace bagnold::scenario {

// Grains at rest fill about 0.58 of the space, a cubic lattice of one grain per d^3 pi/6 of it.
double filling_height(const BedRecipe& recipe) { return recipe.thickness * 0.58 * 6 / std::numbers::pi; }

Bed settle_bed(const BedRecipe& recipe) {
  const Chute box{.angle_deg = 0,
                  .length = recipe.length,
                  .width = recipe.width,
                  .fill_height = filling_height(recipe),
                  .base_size_ratio = 0};
  const GrainMaterial material{.size_spread = recipe.size_spread};
  dem::DemState state = make_chute(box, material, {}, static_cast<std::uint64_t>(recipe.seed));
  const dem::PairParameters pair{
      laws::Linear{.collision_time = recipe.collision_time, .restitution = recipe.restitution},
      laws::LinearHistory{.friction = recipe.friction}, laws::NoRollingResistance{}};
  const dem::ContactLaws laws =
      dem::compile(dem::uniform_model({"grain", "base"}, pair), dem::mean_pair_mass(state.grains));
  state.dt = recipe.collision_time / 20;  // what matters is where grains come to rest, not how
  dem::prepare(state, laws);

  const auto interval = static_cast<std::int64_t>(1 / state.dt);
  const double limit = 40 + 20 * std::sqrt(recipe.thickness);  // far more than any bed took
  dem::Energies e;
  while (state.time() < limit) {
    dem::advance(state, laws, interval);
    e = dem::energies(state, laws);
    if (state.time() > 10 && e.kinetic() < 1e-5 * e.elastic()) return {state.grains.x, state.grains.diameter};
  }
  // A grain that no other presses on may roll to and fro in its cage on the floor for ever. In a thin bed, with little
  // elastic energy, that is enough to miss the criterion; 1e-6 m g d a grain is rest all the same.
  if (e.kinetic() < 1e-6 * static_cast<double>(state.grains.flowing)) return {state.grains.x, state.grains.diameter};
  throw NumericalError(
      fmt::format("the bed of {} grains did not come to rest within t = {:g}", state.grains.flowing, limit));
}

std::vector<Vec3> cut_base(const Bed& bed) {
  std::vector<Vec3> base;
  for (const Vec3& x : bed.x)
    if (x.z >= 9.3 && x.z <= 11) base.push_back(x - Vec3{0, 0, 11});
  return base;
}

}  // namespace bagnold::scenario

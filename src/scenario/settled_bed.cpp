#include "scenario/settled_bed.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/error.hpp"
#include "core/random.hpp"
#include "core/variant.hpp"
#include "dem/algorithm.hpp"
#include "dem/energy.hpp"
#include "dem/step_limit.hpp"
#include "scenario/granular.hpp"

namespace bagnold::scenario {

namespace {

// Grains at rest fill about 0.58 of the space, a cubic lattice of one grain per d^3 pi/6 of it: so many layers of that
// settle to a diameter.
constexpr double layers = 0.58 * 6 / std::numbers::pi;

Chute box_of(const BedRecipe& recipe) {
  return {.angle_deg = 0,
          .length = recipe.length,
          .width = recipe.width,
          .fill_height = recipe.thickness * layers,
          .base_size_ratio = 0};
}
std::uint64_t seed_of(const BedRecipe& recipe) { return static_cast<std::uint64_t>(recipe.seed); }

dem::ContactModel contacts_of(const BedRecipe& recipe) {
  return dem::uniform_model({"grain", "base"},
                            {laws::Linear{.stiffness = recipe.stiffness, .damping = recipe.damping},
                             laws::LinearHistory{.friction = recipe.friction}, laws::NoRollingResistance{}});
}

// Baseline has the same bits on every processor; a build without it makes other beds.
Variant bed_variant() { return executable(Variant::baseline) ? Variant::baseline : variant(); }

// The only place where a bed takes steps: what is called here decides its bits (bed_path).
void step_bed(dem::DemState& state, const dem::ContactLaws& laws, std::int64_t steps) {
  dem::advance(state, laws, steps);
}

// Kinetic energy of all grains but a twentieth, the fastest, and but two at least.
double kinetic_of_the_slow(const dem::DemState& state) {
  std::vector<double> energy;
  for (std::int64_t i = 0; i < state.grains.flowing; ++i) {
    const auto k = static_cast<std::size_t>(i);
    energy.push_back(0.5 * (state.grains.mass[k] * norm2(dem::full_step_velocity(state, i)) +
                            state.grains.inertia[k] * norm2(dem::full_step_omega(state, i))));
  }
  std::sort(energy.begin(), energy.end());
  const std::size_t loose = std::min(energy.size(), std::max<std::size_t>(2, energy.size() / 20));
  return std::accumulate(energy.begin(), energy.end() - static_cast<std::ptrdiff_t>(loose), 0.0);
}

// `steps` steps, looking up now and then; false: to be given up. However they are cut, the steps are the same.
bool advance(dem::DemState& state, const dem::ContactLaws& laws, std::int64_t steps, const SettlingWatch& watch,
             Settling& now) {
  const std::int64_t piece = std::max<std::int64_t>(20, 2'000'000 / state.grains.flowing);
  for (const std::int64_t end = state.step + steps; state.step < end;) {
    step_bed(state, laws, std::min(piece, end - state.step));
    now.step = state.step;
    now.time = state.time();
    if (watch && !watch(now)) return false;
  }
  return true;
}

}  // namespace

std::string_view bed_path() {
  switch (bed_variant()) {
    case Variant::avx2: return "settle_bed 3, avx2";
    case Variant::avx512: return "settle_bed 3, avx512";
    default: return "settle_bed 3";
  }
}

std::int64_t bed_grains(const BedRecipe& recipe) { return grain_count(box_of(recipe), 1); }

double bed_steps(const BedRecipe& recipe) {
  const double smallest = 1 - recipe.size_spread;
  return 15 * std::sqrt(recipe.thickness) / (recipe.step * smallest * std::sqrt(smallest));
}

std::optional<Bed> settle_bed(const BedRecipe& recipe, const SettlingWatch& watch) {
  const WithVariant portable(bed_variant());
  dem::DemState state = make_chute(box_of(recipe), {.size_spread = recipe.size_spread}, {}, seed_of(recipe));
  const dem::ContactModel model = contacts_of(recipe);
  const dem::ContactLaws laws = dem::compile(model, dem::mean_pair_mass(state.grains));
  state.dt = recipe.step;
  if (recipe.size_spread > 0) state.dt = std::min(state.dt, 2 * dem::step_limit(state, model).step);
  dem::prepare(state, laws);

  const auto interval = static_cast<std::int64_t>(1 / state.dt);
  Settling now{0, 0, 40 + 20 * std::sqrt(recipe.thickness), INFINITY};  // far more than any bed took
  dem::Energies e;
  const auto bed = [&] { return Bed{state.grains.x, state.grains.diameter}; };
  while (state.time() < now.latest) {
    if (!advance(state, laws, interval, watch, now)) return {};
    e = dem::energies(state, laws);
    now.energy_ratio = e.kinetic() / e.elastic();
    if (state.time() > 10 && e.kinetic() < 1e-5 * e.elastic()) return bed();
  }
  // Nothing stops a grain that no other presses on from rolling to and fro in its cage on the floor. The bed is at rest all
  // the same if the others are, to 1e-6 m g d a grain.
  if (kinetic_of_the_slow(state) < 1e-6 * static_cast<double>(state.grains.flowing)) return bed();
  throw NumericalError(
      fmt::format("the bed of {} grains did not come to rest within t = {:g}", state.grains.flowing, now.latest));
}

Bed stand_in_bed(const BedRecipe& recipe) {
  constexpr double solid = 0.6;  // of a bed away from its floor
  check(box_of(recipe), {.size_spread = recipe.size_spread});
  const std::int64_t count = bed_grains(recipe);
  Bed bed{{}, draw_diameters(count, {.size_spread = recipe.size_spread}, seed_of(recipe))};
  double volume = 0;
  for (const double d : bed.diameter) volume += std::numbers::pi / 6 * d * d * d;
  const double top = volume / (solid * recipe.length * recipe.width);
  for (std::uint64_t i = 0; i < bed.diameter.size(); ++i) {
    const auto [u, v] = random::uniform2(seed_of(recipe), random::Stream::base, i, 0);
    const double w = random::uniform(seed_of(recipe), random::Stream::base, i, 1);
    bed.x.push_back({u * recipe.length, v * recipe.width, w * top});
  }
  return bed;
}

std::vector<Vec3> cut_base(const Bed& bed) {
  std::vector<Vec3> base;
  for (const Vec3& x : bed.x)
    if (x.z >= 9.3 && x.z <= 11) base.push_back(x - Vec3{0, 0, 11});
  return base;
}

}  // namespace bagnold::scenario

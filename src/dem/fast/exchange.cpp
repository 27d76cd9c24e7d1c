// Between the plain state and the sorted copy.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "dem/fast/engine.hpp"
#include "dem/neighbours.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

namespace {

double largest_diameter(const Grains& g) { return *std::max_element(g.diameter.begin(), g.diameter.end()); }

double skin_of(const Grains& g) { return 0.24 * *std::min_element(g.diameter.begin(), g.diameter.begin() + g.flowing); }

void choose_kernel(Engine& engine, const Grains& g) {
  engine.alike = true;
  for (std::size_t i = 1; i < static_cast<std::size_t>(g.flowing); ++i)
    engine.alike =
        engine.alike && g.diameter[i] == g.diameter[0] && g.mass[i] == g.mass[0] && g.inertia[i] == g.inertia[0];
  engine.equal_radii = std::all_of(g.diameter.begin(), g.diameter.end(), [&](double d) { return d == g.diameter[0]; });
  with_laws(engine.laws, [&](const auto& tables) {
    engine.constant_numbers = flatten_tables(tables, engine.constants);
    engine.history_numbers = Kernel<std::decay_t<decltype(tables)>, true, true>::history_numbers;
  });
  engine.one_kind = true;
  for (std::size_t k = 0; k < engine.constants.size(); ++k)
    engine.one_kind = engine.one_kind && engine.constants[k] == engine.constants[k % engine.constant_numbers];
}

template <class T>
void release(std::vector<T>& values) {
  std::vector<T>().swap(values);
}

// Where grains were when the lists that the state remembers were made.
std::vector<Vec3> remembered_start(const DemState& state) {
  std::vector<Vec3> start = state.grains.x;
  std::copy(state.pairs.reference.begin(), state.pairs.reference.end(), start.begin());
  return start;
}

// The rows of the grains from the arrays of the state, which are given up one after the other: large flows are in
// memory once.
void take_grains(Engine& engine, Grains& g) {
  Rows& rows = engine.rows;
  const std::size_t count = engine.grain.size();
  const auto fill = [&](Aligned<double>& to, std::size_t doubles, auto&& row_of_grain) {
    to.resize(count * doubles);
    parallel_for(static_cast<std::int64_t>(count), [&](std::int64_t n) {
      double* row = &to[at(n) * doubles];
      std::fill_n(row, doubles, 0.0);
      if (engine.grain[at(n)] >= 0) row_of_grain(row, at(engine.grain[at(n)]));
    });
  };
  const auto put = [](double* row, const Vec3& a, double fourth) {
    row[0] = a.x, row[1] = a.y, row[2] = a.z, row[3] = fourth;
  };
  const auto flows = [&](std::size_t i) { return static_cast<std::int64_t>(i) < g.flowing; };
  const auto inverse_mass = [&](std::size_t i) { return flows(i) ? 1 / g.mass[i] : 0; };
  fill(rows.force, force_doubles, [&](double* row, std::size_t i) {
    put(row, flows(i) ? g.force[i] : Vec3{}, inverse_mass(i));
    put(row + 4, flows(i) ? g.torque[i] : Vec3{}, flows(i) ? 1 / g.inertia[i] : 0);
  });
  release(g.force);
  release(g.torque);
  fill(rows.velocity, velocity_doubles, [&](double* row, std::size_t i) {
    put(row, g.v[i], 0.5 * g.diameter[i]);
    put(row + 4, g.omega[i], inverse_mass(i));
  });
  release(g.v);
  release(g.omega);
  fill(rows.position, position_doubles, [&](double* row, std::size_t i) { put(row, g.x[i], 0.5 * g.diameter[i]); });
  release(g.x);
  for (const Slab& slab : engine.slabs)  // the two that never touch: radius 0, a little apart
    rows.position[position_doubles * (slab.end + 1)] = 0.3 * g.diameter[0];
}

// The way back, again one array after the other; `pairs` are found from the positions.
void give_all(Engine& engine, DemState& state) {
  Grains& g = state.grains;
  Rows& rows = engine.rows;
  const std::size_t count = at(g.size());
  const auto fill = [&](std::vector<Vec3>& to, const Aligned<double>& from, std::size_t doubles, std::size_t first,
                        std::int64_t n) {
    to.resize(count);
    parallel_for(n, [&](std::int64_t i) {
      const double* row = &from[engine.row[at(i)] * doubles + first];
      to[at(i)] = {row[0], row[1], row[2]};
    });
  };
  state.step = engine.step;
  fill(g.force, rows.force, force_doubles, 0, g.flowing);  // 0 on fixed grains
  fill(g.torque, rows.force, force_doubles, 4, g.flowing);
  Aligned<double>().swap(rows.force);
  fill(g.v, rows.velocity, velocity_doubles, 0, g.size());
  fill(g.omega, rows.velocity, velocity_doubles, 4, g.size());
  Aligned<double>().swap(rows.velocity);
  state.pairs = touching_pairs(engine);
  give_walls(engine, state);
  fill(g.x, rows.position, position_doubles, 0, g.size());
  Aligned<double>().swap(rows.position);
}

// When and where the lists were made, and what is known of the excursions since.
void give_origin(const Engine& engine, DemState& state) {
  PairList& pairs = state.pairs;
  pairs.reference.resize(at(state.grains.flowing));
  parallel_for(state.grains.flowing, [&](std::int64_t i) { pairs.reference[at(i)] = engine.start[engine.row[at(i)]]; });
  pairs.origin = {static_cast<double>(engine.built_at), engine.frame.x, engine.frame.y, engine.frame.z};
  for (const Slab& slab : engine.slabs)
    for (const double number : {slab.excursion, slab.drift.speed, slab.drift.distance, slab.acceleration,
                                static_cast<double>(slab.steps_left)})
      pairs.origin.push_back(number);
}

void remember_origin(Engine& engine, const PairList& pairs) {
  engine.built_at = static_cast<std::int64_t>(pairs.origin[0]);
  engine.frame = {pairs.origin[1], pairs.origin[2], pairs.origin[3]};
  for (std::size_t s = 0; s < engine.slabs.size(); ++s) {
    const double* known = &pairs.origin[4 + 5 * s];
    engine.slabs[s].excursion = known[0];
    engine.slabs[s].drift = {known[1], known[2]};
    engine.slabs[s].acceleration = known[3];
    engine.slabs[s].steps_left = static_cast<std::int64_t>(known[4]);
  }
}

// A number that tells the grains of one moment from those of any other. Eight words at a time, so that those the processor
// can multiply at once need not wait for each other.
std::uint64_t fingerprint(const Grains& g) {
  constexpr std::uint64_t odd = 0x9e3779b97f4a7c15;
  using Words = std::array<std::uint64_t, 8>;
  Words lanes{};
  const auto add = [&](const void* data, std::size_t bytes) {
    const auto* from = static_cast<const char*>(data);
    const auto mix = [&](std::size_t begin, std::size_t count) {
      Words words{};
      std::memcpy(&words, from + begin, count);
      for (std::size_t k = 0; k < words.size(); ++k) lanes[k] = std::rotl(lanes[k] ^ words[k], 29) * odd;
    };
    std::size_t b = 0;
    for (; b + sizeof lanes <= bytes; b += sizeof lanes) mix(b, sizeof lanes);
    if (b < bytes) mix(b, bytes - b);
  };
  for (const auto* values : {&g.x, &g.v, &g.omega, &g.force, &g.torque})
    add(values->data(), values->size() * sizeof(Vec3));
  for (const auto* values : {&g.diameter, &g.mass, &g.inertia}) add(values->data(), values->size() * sizeof(double));
  add(g.species.data(), g.species.size() * sizeof(std::int32_t));
  std::uint64_t all = static_cast<std::uint64_t>(g.flowing);
  for (std::size_t k = 0; k < 8; ++k) all = std::rotl(all ^ lanes[k], 29) * odd;
  return all;
}

}  // namespace

bool supports(const DemState& state) {
  const Grains& g = state.grains;
  if (g.flowing < fewest_grains) return false;
  for (int k = 0; k < 3; ++k)
    if (state.box.periodic[at(k)] && state.box.length[k] < 2 * (largest_diameter(g) + 2 * skin_of(g))) return false;
  return true;
}

namespace {

// Whether everything but the grains is as the engine knows it.
bool is_known(Engine& engine, const DemState& state, const ContactLaws& laws) {
  if (engine.step != state.step || engine.dt != state.dt || engine.gravity != state.gravity ||
      engine.overlap_ratio != state.max_overlap_ratio)
    return false;
  for (int k = 0; k < 3; ++k)
    if (engine.box.length[k] != state.box.length[k] || engine.box.periodic[at(k)] != state.box.periodic[at(k)])
      return false;
  const auto alike = [](const Wall& a, const Wall& b) {
    return a.point == b.point && a.normal == b.normal && a.species == b.species;
  };
  if (!std::equal(engine.walls.begin(), engine.walls.end(), state.walls.begin(), state.walls.end(), alike))
    return false;
  return with_laws(laws, [&](const auto& tables) {
    flatten_tables(tables, engine.others);
    return engine.others == engine.constants && tables.species == engine.laws.species &&
           laws.normal.index() == engine.laws.normal.index() &&
           laws.tangential.index() == engine.laws.tangential.index() &&
           laws.rolling.index() == engine.laws.rolling.index();
  });
}

bool has_left(const Engine& engine, const DemState& state) {
  return !state.pairs.origin.empty() && engine.row.size() == state.grains.x.size() &&
         engine.left_behind == fingerprint(state.grains);
}

}  // namespace

void load(Engine& engine, DemState& state, const ContactLaws& laws) {
  Grains& g = state.grains;
  engine.laws = laws;
  engine.box = state.box;
  engine.walls = state.walls;
  engine.gravity = state.gravity;
  engine.dt = state.dt;
  engine.overlap_ratio = state.max_overlap_ratio;
  engine.keep_ledger = state.keep_ledger;
  engine.skin = skin_of(g);
  engine.cutoff = largest_diameter(g) + engine.skin;
  engine.step = state.step;
  engine.images = {};
  for (int k = 0; k < 3; ++k)
    if (state.box.periodic[at(k)]) {
      engine.images.length[k] = state.box.length[k];
      engine.images.inverse[k] = 1 / state.box.length[k];
    }
  choose_kernel(engine, g);

  const bool anew = state.pairs.origin.empty();
  if (anew) {
    check_motion(state);
    wrap_positions(state);
  }
  arrange(engine, g, anew ? g.x : remembered_start(state));
  take_grains(engine, g);
  open_ledger(engine);
  measure(engine);
  engine.scratch.resize(std::max(engine.scratch.size(), at(threads())));
  list_inner(engine, state.pairs);
  remember_walls(engine, wall_touches(state));
  if (!anew) remember_origin(engine, state.pairs);
  state.pairs = {};
  state.wall_contacts = {};
  if (anew) start_path(engine, state);
}

void enter(Engine& engine, DemState& state, const ContactLaws& laws) {
  const bool known = is_known(engine, state, laws);
  if (!known) leave(engine, state);
  if (engine.has_grains()) {
    if (engine.keep_ledger == state.keep_ledger) return;
  } else {
    if (!known || !has_left(engine, state)) return load(engine, state, laws);
    state.pairs = {};
    state.wall_contacts = {};
    take_grains(engine, state.grains);
  }
  engine.keep_ledger = state.keep_ledger;
  open_ledger(engine);
}

void leave(Engine& engine, DemState& state) {
  if (!engine.has_grains()) return;
  give_all(engine, state);
  give_origin(engine, state);
  engine.left_behind = fingerprint(state.grains);
}

}  // namespace bagnold::dem::fast

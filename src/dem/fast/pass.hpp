// Steps of an epoch, for one kernel: with the energy ledger (ledger_pass.cpp) or without (engine.cpp).
#pragma once
#include <algorithm>
#include <utility>

#include "core/parallel.hpp"
#include "dem/fast/engine.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

// f.operator()<K>(tables) with the kernel K for the laws and sizes at hand.
template <class F>
void with_kernel(const Engine& engine, F&& f) {
  with_laws(engine.laws, [&](const auto& tables) {
    using T = std::decay_t<decltype(tables)>;
    if (!engine.one_kind) return f.template operator()<Kernel<T, false, false>>(tables);
    if (!engine.equal_radii) return f.template operator()<Kernel<T, false, true>>(tables);
    return f.template operator()<Kernel<T, true, true>>(tables);
  });
}

// Kick and drift of the grains in rows [begin, end): v += kick (F/m + g), x += dt v. Forces start again at 0.
// Returns a bound on their acceleration.
double move_rows(double* position, double* velocity, double* force, std::size_t begin, std::size_t end,
                 const Vec3& gravity, double kick, double dt);

inline KernelInput input_of(const Engine& engine) {
  return {engine.constants.data(), engine.images, engine.dt, engine.overlap_ratio};
}
inline Batches batches_of(Section& section) {
  return {section.inner.i.data(), section.inner.j.data(), section.kind.data(), section.history.data(),
          section.inner.count};
}

// Forces of a section and of the walls on its slab. `pairs` and `walls`: ledgers. Returns by how much the largest overlap
// exceeds the permitted one.
template <class K, class Tables, class PairAccount, class WallAccount>
double act(Engine& engine, const Tables& tables, std::size_t a, PairAccount& pairs, WallAccount& walls,
           ContactPack* seen, std::size_t& packs) {
  Section& section = engine.sections[a];
  const double of_pairs = K::act(engine.rows, batches_of(section), tables, input_of(engine), pairs, seen, packs);
  return std::max(of_pairs, WallKernel<Tables, K::one_kind>::act(engine.rows, section.walls, engine.walls, tables,
                                                                 input_of(engine), walls, seen, packs));
}

// The same with a ledger, and what is left in the springs of contacts that open. Pairs and walls keep what they remember one behind the other.
template <class K, class Tables>
double act_and_account(Engine& engine, const Tables& tables, std::size_t a, OpenedContacts& opened, ContactPack* seen,
                       std::size_t& packs, Losses& losses) {
  using AtWalls = WallKernel<Tables, K::one_kind>;
  Section& section = engine.sections[a];
  const KernelInput input = input_of(engine);
  const Batches pairs = batches_of(section);
  const std::size_t batches = pairs.count / batch + 2;  // one more than there can be: the last is always written
  losses.opened = 0;
  opened.make_room(batches + section.walls.batches.size() + 1, engine.history_numbers);
  const auto account = [&]<bool symmetric>(std::size_t first) {
    return PairLedger<symmetric, K::rolls>{
        engine.ledger.normal.data(),  engine.ledger.tangential.data(),
        engine.ledger.rolling.data(), &opened.history[first * engine.history_numbers * batch],
        &opened.where[first],         0};
  };
  auto of_pairs = account.template operator()<K::symmetric>(0);
  auto of_walls = account.template operator()<true>(batches);
  const double excess = act<K>(engine, tables, a, of_pairs, of_walls, seen, packs);
  if (of_pairs.count + of_walls.count == 0) return excess;
  const auto pair_at = [&](std::size_t p) {
    alignas(64) double in[K::collected * batch];
    K::collect(engine.rows.position.data(), engine.rows.velocity.data(), pairs.i + p, pairs.j + p, engine.images, in);
    return std::pair{K::encounter(in), K::law_of(tables, input, pairs, p)};
  };
  const auto wall_at = [&](std::size_t p) {
    const auto [wall, taken] = section.walls.batches[p / batch];
    return std::pair{
        AtWalls::encounter(engine.rows, &section.walls.i[p], &section.walls.j[p], engine.walls[wall], taken),
        AtWalls::law_of(tables, input, section.walls, p)};
  };
  losses.opened = energy_of(of_pairs, input.dt, pair_at) + energy_of(of_walls, input.dt, wall_at);
  return excess;
}

// Adds the forces of section a and of the walls on slab a, and shows their contacts to a watch.
template <class K, bool keeps_ledger, class Tables>
void act(Engine& engine, const Tables& tables, std::size_t a, Scratch& scratch, const Watch* watch, Losses* losses) {
  const Section& section = engine.sections[a];
  ContactPack* seen = nullptr;
  std::size_t packs = 0;
  if (watch != nullptr) {
    const std::size_t most = section.inner.count / batch + 1 + section.walls.batches.size();
    if (scratch.packs.size() < most) scratch.packs.resize(most * 5 / 4 + 8);
    seen = scratch.packs.data();
  }
  double excess = 0;
  if constexpr (keeps_ledger) {
    excess = act_and_account<K>(engine, tables, a, scratch.opened, seen, packs, *losses);
  } else {
    NoLedger none;
    excess = act<K>(engine, tables, a, none, none, seen, packs);
  }
  scratch.excess = std::max(scratch.excess, excess);
  if (watch != nullptr) watch->fast_contacts(engine, a, ContactPacks(seen, packs));
}

// Steps [from, to) of an epoch; `watch` if the last is looked at.
template <class K, bool keeps_ledger, class Tables>
void pass(Engine& engine, const Tables& tables, int from, int to, const Watch* watch) {
  const auto losses = [&](int s, int t) {
    return keeps_ledger ? &engine.ledger.losses[at(t - from) * engine.slabs.size() + at(s)] : nullptr;
  };
  const auto account = [&](int s, int t) {  // all forces of step t are there
    if constexpr (keeps_ledger) take_losses(engine, engine.slabs[at(s)], 0.5 * engine.dt, *losses(s, t));
  };
  const auto move = [&](int s, int t) {
    if (t > from) account(s, t - 1);
    Slab& slab = engine.slabs[at(s)];
    const double kick = engine.step + t - from == 0 ? 0.5 * engine.dt : engine.dt;  // the first step closes no other
    slab.acceleration = move_rows(engine.rows.position.data(), engine.rows.velocity.data(), engine.rows.force.data(),
                                  slab.begin, slab.moving_end, engine.gravity, kick, engine.dt);
    slab.drift.step(engine.dt, slab.acceleration);
    --slab.steps_left;
  };
  if (watch != nullptr && !watch->fast_contacts) watch = nullptr;
  const auto forces = [&](int s, int t) {
    const auto a = at(s), b = at(engine.ring.wrap(s + 1));
    Section& section = engine.sections[a];
    Scratch& scratch = engine.scratch[at(thread_index())];
    section.mid_valid.step(engine.dt, engine.slabs[a].acceleration, engine.slabs[b].acceleration);
    section.inner_valid.step(engine.dt, engine.slabs[a].acceleration, engine.slabs[b].acceleration);
    if (!section.mid_valid.holds() || !section.inner_valid.holds()) refresh(engine, a, scratch);
    act<K, keeps_ledger>(engine, tables, a, scratch, t == to - 1 ? watch : nullptr, losses(s, t));
  };
  sweep(engine.ring, from, to, engine.grain.size() >= 500, move, forces);
  if constexpr (keeps_ledger)
    parallel_for(
        engine.ring.slabs, [&](std::int64_t s) { account(static_cast<int>(s), to - 1); }, engine.grain.size() >= 500);
}

// The forces at the present positions, with velocities of the same time; springs stay as they are.
template <class K, bool keeps_ledger, class Tables>
void all_forces(Engine& engine, const Tables& tables) {
  for (std::size_t a = 0; a < engine.sections.size(); ++a)
    act<K, keeps_ledger>(engine, tables, a, engine.scratch[0], nullptr,
                         keeps_ledger ? &engine.ledger.losses[a] : nullptr);
  if constexpr (keeps_ledger)
    for (std::size_t s = 0; s < engine.slabs.size(); ++s)
      take_losses(engine, engine.slabs[s], 0, engine.ledger.losses[s]);
}

// The two above for the kernel at hand.
void forces_without_ledger(Engine& engine);
void forces_with_ledger(Engine& engine);
void pass_without_ledger(Engine& engine, int from, int to, const Watch* watch);
void pass_with_ledger(Engine& engine, int from, int to, const Watch* watch);

}  // namespace bagnold::dem::fast

#pragma GCC diagnostic pop

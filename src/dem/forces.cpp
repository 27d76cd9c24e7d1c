#include "dem/forces.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "dem/contact_laws.hpp"

namespace bagnold::dem {

namespace {

constexpr int max_parts = 64;  // slabs of pairs, or blocks of grains at walls: units of parallel work

// What one part of the list adds up beside the forces.
struct Tally {
  double excess = 0;  // largest overlap beyond the permitted one; 0 if none
  double sliding = 0, roll_sliding = 0, opened = 0;
};
using Tallies = std::array<Tally, max_parts>;

// The contact in slot k of `touching`, `spring`, `roll` advances by dt and acts; returns what it does.
template <bool KeepLedger, class Law, class Contacts>
Force act(Contacts& contacts, std::size_t k, const Law& law, const Motion& motion, const Size& size, double permitted,
          double dt, Tally& tally) {
  const Geometry geometry = laws::pair_geometry(motion);
  History history{numbers(contacts.spring[k]), {0, 0, 0}};
  if constexpr (decltype(law.rolling)::active) history.roll = numbers(contacts.roll[k]);
  const Force force = laws::interact<true>(law, geometry, size, dt, history);
  contacts.spring[k] = vec3(history.spring);
  if constexpr (decltype(law.rolling)::active) contacts.roll[k] = vec3(history.roll);
  contacts.touching[k] = 1;
  tally.excess = max(tally.excess, geometry.overlap - permitted);
  if constexpr (KeepLedger) {
    tally.sliding += force.slide_loss;
    tally.roll_sliding += force.roll_loss;
  }
  return force;
}

// Springs are forgotten when a contact opens.
template <class Law, class Contacts>
void open(Contacts& contacts, std::size_t k, const Law& law, const Motion& motion, const Size& size, double dt,
          Tally& tally) {
  const History history{numbers(contacts.spring[k]), numbers(contacts.roll[k])};
  tally.opened += laws::energy_left(law, laws::pair_geometry(motion), size, history, dt);
  contacts.touching[k] = 0;
  contacts.spring[k] = contacts.roll[k] = Vec3{};
}

template <bool KeepLedger, class Tables>
Tally slab_forces(DemState& state, const Tables& tables, const std::array<Vec3, 27>& shift, int slab, double dt) {
  Grains& g = state.grains;
  PairList& pairs = state.pairs;
  Tally tally;
  for (auto p = at(pairs.slab_begin[at(slab)]); p < at(pairs.slab_begin[at(slab) + 1]); ++p) {
    const auto i = at(pairs.i[p]), j = at(pairs.j[p]);
    const Vec3 r = g.x[i] - g.x[j] - shift[pairs.image[p]];
    const double reach = 0.5 * (g.diameter[i] + g.diameter[j]);
    const bool apart = norm2(r) >= reach * reach;
    if (apart && !pairs.touching[p]) continue;
    const auto law = tables.of(g.species[i], g.species[j]);
    const Motion motion = pair_motion(g, i, j, r);
    const Size size = pair_size(g, i, j);
    if (apart) {
      open(pairs, p, law, motion, size, dt, tally);
      continue;
    }
    const double permitted = 0.5 * state.max_overlap_ratio * min(g.diameter[i], g.diameter[j]);
    const Force f = act<KeepLedger>(pairs, p, law, motion, size, permitted, dt, tally);
    g.force[i] += vec3(f.force);
    g.torque[i] += vec3(f.torque_i);
    if (pairs.j[p] >= g.flowing) continue;
    g.force[j] -= vec3(f.force);
    g.torque[j] += vec3(f.torque_j);
  }
  return tally;
}

template <bool KeepLedger, class Tables>
Tally wall_forces(DemState& state, const Tables& tables, std::int64_t begin, std::int64_t end, double dt) {
  Grains& g = state.grains;
  WallContacts& contacts = state.wall_contacts;
  Tally tally;
  for (std::size_t w = 0; w < state.walls.size(); ++w) {
    const Wall& wall = state.walls[w];
    for (auto i = at(begin); i < at(end); ++i) {
      const std::size_t k = w * at(g.flowing) + i;
      const bool apart = height_above(wall, g.x[i]) >= 0.5 * g.diameter[i];
      if (apart && !contacts.touching[k]) continue;
      const auto law = tables.of(g.species[i], wall.species);
      const Motion motion = wall_motion(g, i, wall);
      if (apart) {
        open(contacts, k, law, motion, wall_size(g, i), dt, tally);
        continue;
      }
      const double permitted = 0.5 * state.max_overlap_ratio * g.diameter[i];
      const Force f = act<KeepLedger>(contacts, k, law, motion, wall_size(g, i), permitted, dt, tally);
      g.force[i] += vec3(f.force);
      g.torque[i] += vec3(f.torque_i);
    }
  }
  return tally;
}

void add(DemState& state, const Tallies& tallies, int parts, double& excess) {
  for (int s = 0; s < parts; ++s) {
    const Tally& t = tallies[at(s)];
    excess = std::max(excess, t.excess);
    state.ledger.sliding += t.sliding;
    state.ledger.roll_sliding += t.roll_sliding;
    state.ledger.opened += t.opened;
  }
}

template <bool KeepLedger, class Tables>
double sum_forces(DemState& state, const Tables& tables, double dt) {
  Grains& g = state.grains;
  parallel_for(
      g.flowing, [&](std::int64_t i) { g.force[at(i)] = g.torque[at(i)] = Vec3{}; }, worth_threads(g));
  double excess = 0;
  Tallies tallies;
  const auto shift = neighbours::image_shifts(state.box);
  const int slabs = static_cast<int>(state.pairs.slab_begin.size()) - 1;
  for (int parity = 0; parity < 2; ++parity)  // slab s writes to grains of s and s + 1
    parallel_for((slabs + 1 - parity) / 2,
                 [&](std::int64_t k) {
                   const int slab = static_cast<int>(2 * k) + parity;
                   tallies[at(slab)] = slab_forces<KeepLedger>(state, tables, shift, slab, dt);
                 },
                 worth_threads(g));
  add(state, tallies, slabs, excess);
  if (!state.walls.empty()) {
    const std::int64_t block = (g.flowing + max_parts - 1) / max_parts;
    const std::int64_t blocks = (g.flowing + block - 1) / block;
    parallel_for(
        blocks,
        [&](std::int64_t b) {
          tallies[at(b)] = wall_forces<KeepLedger>(state, tables, b * block, std::min((b + 1) * block, g.flowing), dt);
        },
        worth_threads(g));
    add(state, tallies, static_cast<int>(blocks), excess);
  }
  return excess;
}

}  // namespace

void report_overlap(const DemState& state) {
  const Grains& g = state.grains;
  const auto shift = neighbours::image_shifts(state.box);
  const auto fail = [&](std::int64_t id, const std::string& partner, double ratio) {
    throw NumericalError(
        fmt::format("grain {} at step {} (t = {:g}): overlap with {} is {:.3g} of its radius; the contact "
                    "is too soft for the load or the step too long",
                    id, state.step, state.time(), partner, ratio));
  };
  for (std::int64_t p = 0; p < state.pairs.size(); ++p) {
    const auto i = at(state.pairs.i[at(p)]), j = at(state.pairs.j[at(p)]);
    const double overlap =
        0.5 * (g.diameter[i] + g.diameter[j]) - norm(g.x[i] - g.x[j] - shift[state.pairs.image[at(p)]]);
    const double ratio = 2 * overlap / std::min(g.diameter[i], g.diameter[j]);
    if (ratio > state.max_overlap_ratio) fail(g.id[i], fmt::format("grain {}", g.id[j]), ratio);
  }
  for (std::size_t w = 0; w < state.walls.size(); ++w)
    for (std::int64_t i = 0; i < g.flowing; ++i) {
      const double ratio = 1 - 2 * height_above(state.walls[w], g.x[at(i)]) / g.diameter[at(i)];
      if (ratio > state.max_overlap_ratio) fail(g.id[at(i)], fmt::format("wall {}", w), ratio);
    }
  throw NumericalError(fmt::format("step {}: an overlap is too large", state.step));
}

void evaluate_forces(DemState& state, const ContactLaws& laws, double dt) {
  const double excess = with_laws(laws, [&](const auto& tables) {
    return state.keep_ledger ? sum_forces<true>(state, tables, dt) : sum_forces<false>(state, tables, dt);
  });
  if (excess > 0) report_overlap(state);
}

}  // namespace bagnold::dem

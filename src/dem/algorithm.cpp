#include "dem/algorithm.hpp"

#include <fmt/core.h>

#include <cmath>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "dem/contact_laws.hpp"
#include "dem/energy.hpp"
#include "dem/fast/engine.hpp"
#include "dem/forces.hpp"
#include "dem/neighbours.hpp"

namespace bagnold::dem {

namespace {

// v, omega from t - dt/2 to t + dt/2: the closing half kick of one step and the opening half kick of the next in
// one. The first step has only the opening half.
void kick(DemState& state) {
  Grains& g = state.grains;
  const double dt = state.step == 0 ? 0.5 * state.dt : state.dt;
  parallel_for(
      g.flowing,
      [&](std::int64_t k) {
        const auto i = at(k);
        g.v[i] += dt / g.mass[i] * g.force[i] + dt * state.gravity;
        g.omega[i] += dt / g.inertia[i] * g.torque[i];
      },
      worth_threads(g));
}

void drift(DemState& state) {
  Grains& g = state.grains;
  parallel_for(
      g.flowing, [&](std::int64_t i) { g.x[at(i)] += state.dt * g.v[at(i)]; }, worth_threads(g));
}

void check(const DemState& state, const ContactLaws& laws) {
  const Grains& g = state.grains;
  if (!(state.dt > 0 && std::isfinite(state.dt))) throw UnphysicalError("time.step", "must be positive");
  for (const auto* values : {&g.diameter, &g.mass, &g.inertia})
    for (const double value : *values)
      if (!(value > 0 && std::isfinite(value)))
        throw UnphysicalError("grains", "diameters, masses and moments of inertia must be positive");
  for (const std::int32_t s : g.species)
    if (s < 0 || s >= laws.species) throw UnphysicalError("grains", fmt::format("species {} does not exist", s));
  for (const Wall& wall : state.walls) {
    if (wall.species < 0 || wall.species >= laws.species)
      throw UnphysicalError("walls", fmt::format("species {} does not exist", wall.species));
    if (!(std::abs(norm(wall.normal) - 1) < 1e-12)) throw UnphysicalError("walls", "the normal must be a unit vector");
    for (int k = 0; k < 3; ++k)
      if (state.box.periodic[at(k)] && wall.normal[k] != 0)
        throw UnphysicalError("walls", "a wall must be parallel to the periodic directions of the box");
  }
}

}  // namespace

void prepare(DemState& state, const ContactLaws& laws) {
  check(state, laws);
  const auto n = at(state.grains.size());
  state.grains.force.assign(n, {});
  state.grains.torque.assign(n, {});
  for (auto i = at(state.grains.flowing); i < n; ++i) state.grains.v[i] = state.grains.omega[i] = {};
  const std::size_t at_walls = state.walls.size() * at(state.grains.flowing);
  state.wall_contacts = {std::vector<std::uint8_t>(at_walls), std::vector<Vec3>(at_walls), std::vector<Vec3>(at_walls)};
  state.pairs = {};
  state.ledger = {};
  state.step = state.rebuilds = state.next_reorder = 0;
  if (state.skin <= 0) state.skin = default_skin(state.grains);
  if (fast::supports(state)) return fast::prepare(state, laws);
  rebuild_pairs(state);
  evaluate_forces(state, laws, 0);
  if (state.keep_ledger) balance_ledger(state, laws);
}

void advance(DemState& state, const ContactLaws& laws, std::int64_t steps, const Watch& watch) {
  advance_inside(state, laws, steps, watch);
  hand_back(state);
}

void hand_back(DemState& state) { fast::hand_back(state); }

void advance_inside(DemState& state, const ContactLaws& laws, std::int64_t steps, const Watch& watch) {
  if (fast::supports(state)) return fast::advance(state, laws, steps, watch);
  for (const std::int64_t end = state.step + steps; state.step < end;) {
    advance_plain(state, laws, watch.next_stop(state.step, end) - state.step);
    if (watch.sees(state.step)) watch.plain(state);
  }
}

void advance_plain(DemState& state, const ContactLaws& laws, std::int64_t steps) {
  hand_back(state);
  for (const std::int64_t end = state.step + steps; state.step < end;) {
    kick(state);   // v, omega at t + dt/2
    drift(state);  // x at t + dt
    ++state.step;
    refresh_pairs(state);                    // pairs (i, j) that may be in contact
    evaluate_forces(state, laws, state.dt);  // springs by dt, then f, q at t + dt
    if (state.keep_ledger) balance_ledger(state, laws);
  }
}

Vec3 full_step_velocity(const DemState& state, std::int64_t i) {
  const Grains& g = state.grains;
  if (state.step == 0 || i >= g.flowing) return g.v[at(i)];
  return g.v[at(i)] + 0.5 * state.dt / g.mass[at(i)] * g.force[at(i)] + 0.5 * state.dt * state.gravity;
}

Vec3 full_step_omega(const DemState& state, std::int64_t i) {
  const Grains& g = state.grains;
  if (state.step == 0 || i >= g.flowing) return g.omega[at(i)];
  return g.omega[at(i)] + 0.5 * state.dt / g.inertia[at(i)] * g.torque[at(i)];
}

}  // namespace bagnold::dem

#include "dem/energy.hpp"

#include <algorithm>

#include "dem/algorithm.hpp"
#include "dem/visit_contacts.hpp"

namespace bagnold::dem {

Energies energies(const DemState& state, const ContactLaws& laws) {
  const Grains& g = state.grains;
  Energies e;
  for (std::int64_t i = 0; i < g.flowing; ++i) {
    e.translational += 0.5 * g.mass[at(i)] * norm2(full_step_velocity(state, i));
    e.rotational += 0.5 * g.inertia[at(i)] * norm2(full_step_omega(state, i));
    e.gravity -= g.mass[at(i)] * dot(state.gravity, g.x[at(i)]);
  }
  e.gravity -= state.ledger.wrapped;
  with_laws(laws, [&](const auto& tables) {
    visit_contacts(state, tables, [&](const auto& c) {
      e.normal_spring += c.law.normal.energy(c.geometry.overlap, c.size);
      e.tangential_spring += 0.5 * c.force.tangential_stiffness * dot(c.history.spring, c.history.spring);
      e.rolling_spring += 0.5 * c.force.roll_stiffness * dot(c.history.roll, c.history.roll);
    });
  });
  return e;
}

double lost(const Ledger& l) {
  return l.damped.normal + l.damped.tangential + l.damped.rolling + l.sliding + l.roll_sliding + l.opened;
}

void balance_ledger(DemState& state, const ContactLaws& laws) {
  Dissipation power;
  with_laws(laws, [&](const auto& tables) {
    visit_contacts(state, tables, [&](const auto& c) {
      // The dashpots act on half-step velocities; their power is their force at the velocities of the same time.
      Motion motion = c.motion;
      motion.v = numbers(full_step_velocity(state, c.i) - (c.j < 0 ? Vec3{} : full_step_velocity(state, c.j)));
      const Vec3 omega_i = full_step_omega(state, c.i), omega_j = c.j < 0 ? Vec3{} : full_step_omega(state, c.j);
      motion.spin_sum = numbers(omega_i + omega_j);
      motion.spin_difference = numbers(omega_i - omega_j);
      const Geometry now = laws::pair_geometry(motion);
      power.normal -= c.force.normal_damping * now.vn;
      power.tangential -= dot(c.force.tangential_damping, now.slip);
      power.rolling -= dot(c.force.roll_damping, now.spin);
    });
  });
  integrate(state.ledger, power, state.step > 0 ? state.dt : 0);
}

void integrate(Ledger& l, const Dissipation& power, double dt) {
  l.damped.normal += 0.5 * dt * (l.power.normal + power.normal);
  l.damped.tangential += 0.5 * dt * (l.power.tangential + power.tangential);
  l.damped.rolling += 0.5 * dt * (l.power.rolling + power.rolling);
  l.power = power;
}

double max_overlap_over_radius(const DemState& state) {
  const Grains& g = state.grains;
  const auto shift = neighbours::image_shifts(state.box);
  double largest = 0;
  for (std::size_t p = 0; p < state.pairs.touching.size(); ++p) {
    if (!state.pairs.touching[p]) continue;
    const auto i = at(state.pairs.i[p]), j = at(state.pairs.j[p]);
    const double overlap = 0.5 * (g.diameter[i] + g.diameter[j]) - norm(g.x[i] - g.x[j] - shift[state.pairs.image[p]]);
    largest = std::max(largest, 2 * overlap / std::min(g.diameter[i], g.diameter[j]));
  }
  for (std::size_t w = 0; w < state.walls.size(); ++w)
    for (std::int64_t i = 0; i < g.flowing; ++i)
      largest = std::max(largest, 1 - 2 * height_above(state.walls[w], g.x[at(i)]) / g.diameter[at(i)]);
  return largest;
}

}  // namespace bagnold::dem

// The time loop: velocity Verlet with contact springs, Weinhart et al. 2012, algorithm 1.
#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>

#include "dem/contact_model.hpp"
#include "dem/fast/contact_pack.hpp"
#include "dem/state.hpp"

namespace bagnold::dem {

// Looks at a run from inside, after steps first, first + every, ... up to last; the engine at work calls its function
// and neither knows what it is for nor is changed by it.
struct Watch {
  std::int64_t first = 0, last = -1, every = 1;
  std::function<void(const DemState&)> plain;
  // Of the fast engine (dem/fast/engine.hpp): before the steps that lead to the one looked at; with the contacts of a section as
  // soon as they have their forces, by any thread, but never for two sections at once that share a slab; and after the step.
  // The first two may be left out.
  std::function<void(const fast::Engine&)> fast_before;
  std::function<void(const fast::Engine&, std::size_t section, fast::ContactPacks)> fast_contacts;
  std::function<void(const fast::Engine&)> fast;

  // Next step after `step` that is looked at; none if it is later than `last`.
  std::int64_t next(std::int64_t step) const {
    return step < first ? first : first + ((step - first) / every + 1) * every;
  }
  bool sees(std::int64_t step) const { return step >= first && step <= last && (step - first) % every == 0; }
  // `end`, or where to stop before it to look.
  std::int64_t next_stop(std::int64_t step, std::int64_t end) const {
    const std::int64_t look = next(step);
    return look <= last ? std::min(look, end) : end;
  }
};

// Makes a state of positions and velocities at t = 0 ready to step: neighbour list, springs at 0, initial forces.
// Throws UnphysicalError for a state that cannot be stepped (dt, masses, species, walls).
void prepare(DemState& state, const ContactLaws& laws);

// Takes `steps` steps. Throws NumericalError, the state being complete. By the fast engine
// (dem/fast/engine.hpp) where it can, otherwise plainly; their trajectories differ by round-off only.
void advance(DemState& state, const ContactLaws& laws, std::int64_t steps, const Watch& watch = {});

// The same for who goes on or only looks (dem/observe.hpp): the fast engine may keep the grains, and but for its step the
// state has none until hand_back() completes it. Nothing to complete: nothing happens.
void advance_inside(DemState& state, const ContactLaws& laws, std::int64_t steps, const Watch& watch = {});
void hand_back(DemState& state);

// Algorithm 1 step by step: the reference.
void advance_plain(DemState& state, const ContactLaws& laws, std::int64_t steps);

// Velocities at the time of the positions, for output.
Vec3 full_step_velocity(const DemState& state, std::int64_t i);
Vec3 full_step_omega(const DemState& state, std::int64_t i);

}  // namespace bagnold::dem

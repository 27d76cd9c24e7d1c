// The time loop: velocity Verlet with contact springs, Weinhart et al. 2012, algorithm 1.
#pragma once
#include <cstdint>

#include "dem/contact_model.hpp"
#include "dem/state.hpp"

namespace bagnold::dem {

// Makes a state of positions and velocities at t = 0 ready to step: neighbour list, springs at 0, initial forces.
// Throws UnphysicalError for a state that cannot be stepped (dt, masses, species, walls).
void prepare(DemState& state, const ContactLaws& laws);

// Takes `steps` steps. Allocates only when the neighbour list is rebuilt. Throws NumericalError. By the fast engine
// (dem/fast/engine.hpp) where it can, otherwise plainly; their trajectories differ by round-off only.
void advance(DemState& state, const ContactLaws& laws, std::int64_t steps);

// Algorithm 1 step by step: the reference.
void advance_plain(DemState& state, const ContactLaws& laws, std::int64_t steps);

// Velocities at the time of the positions, for output.
Vec3 full_step_velocity(const DemState& state, std::int64_t i);
Vec3 full_step_omega(const DemState& state, std::int64_t i);

}  // namespace bagnold::dem

// Contact forces and torques of every touching pair and wall contact, with the advance of their springs.
#pragma once
#include "dem/contact_model.hpp"
#include "dem/state.hpp"

namespace bagnold::dem {

// Weinhart et al. 2012, algorithm 1: at the present positions, springs advance by `dt` with the half-step velocities
// (0 at the start), then force and torque are summed. The order of summation is that of the stored list, whatever the number of threads.
// Throws NumericalError when an overlap exceeds max_overlap_ratio.
void evaluate_forces(DemState& state, const ContactLaws& laws, double dt);

// Names the pair whose overlap is too large.
[[noreturn]] void report_overlap(const DemState& state);

}  // namespace bagnold::dem

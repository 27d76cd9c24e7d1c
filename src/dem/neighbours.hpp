// The Verlet list: when it is stale, and how it is made anew without losing the history of contacts.
#pragma once
#include "dem/state.hpp"

namespace bagnold::dem {

// Margin that balances rebuilds against listed pairs that do not touch.
double default_skin(const Grains& grains);

// Throws NumericalError when a grain has left the finite numbers or moved by half its diameter in one step.
void check_motion(const DemState& state);

// Wraps positions into the box and books what that does to the potential energy.
void wrap_positions(DemState& state);

// Wraps positions into the box, sorts grains in space when that is due, and lists all pairs closer than contact plus
// skin. Springs of touching pairs are kept.
void rebuild_pairs(DemState& state);

// The list is sure to hold every touching pair while no flowing grain has moved by more than skin/2. Rebuilds if one
// has, or if another engine left only the touching pairs.
void refresh_pairs(DemState& state);

}  // namespace bagnold::dem

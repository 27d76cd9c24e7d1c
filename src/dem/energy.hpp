// Energies of a state by part, and the ledger that closes their balance.
#pragma once
#include "dem/contact_model.hpp"
#include "dem/state.hpp"

namespace bagnold::dem {

struct Energies {
  double translational = 0, rotational = 0;  // of full-step velocities
  double gravity = 0;                        // -sum m g . x, periodic images followed
  double normal_spring = 0, tangential_spring = 0, rolling_spring = 0;
  double kinetic() const { return translational + rotational; }
  double elastic() const { return normal_spring + tangential_spring + rolling_spring; }
  double total() const { return kinetic() + gravity + elastic(); }
};

// Reads the state, changes nothing.
Energies energies(const DemState& state, const ContactLaws& laws);

// Everything the ledger says has been lost so far: total() + lost(ledger) stays at its first value, to the error of the step.
double lost(const Ledger& ledger);

// Called once a step after the forces: integrates the power of the dashpots at the full-step velocities.
void balance_ledger(DemState& state, const ContactLaws& laws);

// Enters the power of the dashpots at a step that comes `dt` after the last: trapezoidal rule.
void integrate(Ledger& ledger, const Dissipation& power, double dt);

// Largest overlap over the smaller radius of the pair; 0 without contacts.
double max_overlap_over_radius(const DemState& state);

}  // namespace bagnold::dem

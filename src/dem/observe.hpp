// What a flow is asked for again and again: a few sums over its grains and contacts.
#pragma once
#include <cstdint>

#include "dem/energy.hpp"

namespace bagnold::dem {

struct Observation {
  Energies energies;
  Vec3 velocity;              // of the centre of mass of the flowing grains, full step
  double centre_height = 0;   // its z
  std::int64_t contacts = 0;  // as list_contacts()
  double overlap_ratio = 0;   // as max_overlap_over_radius()
};

// By the fast engine where it can, which takes the grains if it does not have them and keeps them (hand_back() in
// dem/algorithm.hpp). A function of the state to the bit, whoever had the grains before; nothing changes.
Observation observe(DemState& state, const ContactLaws& laws);

// The same, plainly.
Observation observe_plain(const DemState& state, const ContactLaws& laws);

}  // namespace bagnold::dem

// The touching pairs as observers see them. Reads the state, changes nothing.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "dem/contact_model.hpp"
#include "dem/state.hpp"

namespace bagnold::dem {

// Fills `out` (whose memory is reused) with every contact, in the stored order: pairs, then walls. The forces are
// those of the last evaluation, to round-off.
void list_contacts(const DemState& state, const ContactLaws& laws, std::vector<Contact>& out);
std::vector<Contact> contacts(const DemState& state, const ContactLaws& laws);

// The part of a Contact that stress and fabric need.
struct ContactForce {
  std::int32_t i, j;
  Vec3 branch, normal, force;
  double overlap;
};

// f(contacts) for all of them in the stored order, a few at a time: nothing is stored for long and nothing allocated.
void for_contact_batches(const DemState& state, const ContactLaws& laws,
                         const std::function<void(std::span<const ContactForce>)>& f);

}  // namespace bagnold::dem

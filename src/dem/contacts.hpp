// The touching pairs as observers see them. Reads the state, changes nothing.
#pragma once
#include <vector>

#include "dem/contact_model.hpp"
#include "dem/state.hpp"

namespace bagnold::dem {

// Fills `out` (whose memory is reused) with every contact, in the stored order: pairs, then walls. The forces are
// those of the last evaluation, to round-off.
void list_contacts(const DemState& state, const ContactLaws& laws, std::vector<Contact>& out);
std::vector<Contact> contacts(const DemState& state, const ContactLaws& laws);

}  // namespace bagnold::dem

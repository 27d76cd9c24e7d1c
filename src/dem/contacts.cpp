#include "dem/contacts.hpp"

#include <array>

#include "dem/visit_contacts.hpp"

namespace bagnold::dem {

void list_contacts(const DemState& state, const ContactLaws& laws, std::vector<Contact>& out) {
  out.clear();
  with_laws(laws, [&](const auto& tables) {
    visit_contacts(state, tables, [&](const auto& c) {
      out.push_back({.i = static_cast<std::int32_t>(c.i),
                     .j = static_cast<std::int32_t>(c.j),
                     .branch = vec3(c.motion.r),
                     .normal = vec3(c.geometry.n),
                     .overlap = c.geometry.overlap,
                     .force = vec3(c.force.force),
                     .torque = vec3(c.force.torque_i),
                     .torque_j = vec3(c.force.torque_j),
                     .normal_force = vec3(c.force.normal * c.geometry.n),
                     .spring = vec3(c.history.spring)});
    });
  });
}

std::vector<Contact> contacts(const DemState& state, const ContactLaws& laws) {
  std::vector<Contact> out;
  list_contacts(state, laws, out);
  return out;
}

void for_contact_batches(const DemState& state, const ContactLaws& laws,
                         const std::function<void(std::span<const ContactForce>)>& f) {
  std::array<ContactForce, 64> batch;
  std::size_t count = 0;
  with_laws(laws, [&](const auto& tables) {
    visit_contacts(state, tables, [&](const auto& c) {
      batch[count++] = {static_cast<std::int32_t>(c.i),
                        static_cast<std::int32_t>(c.j),
                        vec3(c.motion.r),
                        vec3(c.geometry.n),
                        vec3(c.force.force),
                        c.geometry.overlap};
      if (count < batch.size()) return;
      f(batch);
      count = 0;
    });
  });
  if (count > 0) f(std::span(batch).first(count));
}

}  // namespace bagnold::dem

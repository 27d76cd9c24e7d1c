#include "dem/observe.hpp"

#include <algorithm>

#include "dem/algorithm.hpp"
#include "dem/contact_laws.hpp"
#include "dem/fast/engine.hpp"

namespace bagnold::dem {

Observation observe(DemState& state, const ContactLaws& laws) {
  return fast::supports(state) ? fast::observe(state, laws) : observe_plain(state, laws);
}

Observation observe_plain(const DemState& state, const ContactLaws& laws) {
  const Grains& g = state.grains;
  Observation seen{.energies = energies(state, laws), .overlap_ratio = max_overlap_over_radius(state)};
  for (const auto* touching : {&state.pairs.touching, &state.wall_contacts.touching})
    seen.contacts += std::count(touching->begin(), touching->end(), std::uint8_t{1});
  double mass = 0;
  for (std::int64_t i = 0; i < g.flowing; ++i) {
    const double m = g.mass[at(i)];
    seen.velocity += m * full_step_velocity(state, i);
    seen.centre_height += m * g.x[at(i)].z;
    mass += m;
  }
  seen.velocity *= 1 / mass;
  seen.centre_height *= 1 / mass;
  return seen;
}

}  // namespace bagnold::dem

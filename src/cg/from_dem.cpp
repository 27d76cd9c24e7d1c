#include "cg/from_dem.hpp"

#include <algorithm>

#include "dem/contacts.hpp"

namespace bagnold::cg {

Snapshot snapshot_of(const dem::DemState& state, const dem::ContactLaws& laws, DemScratch& scratch) {
  const dem::Grains& g = state.grains;
  const auto n = g.x.size(), flowing = static_cast<std::size_t>(g.flowing);
  scratch.v.assign(n, Vec3{});
  scratch.omega.assign(n, Vec3{});
  const double half = state.step == 0 ? 0 : 0.5 * state.dt;  // velocities are half a step behind once it moves
  for (std::size_t i = 0; i < flowing; ++i) {
    scratch.v[i] = g.v[i] + half * (g.force[i] / g.mass[i] + state.gravity);
    scratch.omega[i] = g.omega[i] + (half / g.inertia[i]) * g.torque[i];
  }
  dem::list_contacts(state, laws, scratch.contacts);
  return {state.time(), state.box, g.x,       scratch.v, scratch.omega,
          g.diameter,   g.mass,    g.inertia, g.flowing, scratch.contacts};
}

namespace {
double spacing_of(const StreamingOptions& o) {
  return o.spacing > 0 ? o.spacing : 0.25 * std::visit([](const auto& k) { return k.width; }, o.kernel);
}
}  // namespace

ProfileObserver::ProfileObserver(const StreamingOptions& options, const Box& box)
    : options_(options), profile_(options.kernel, spacing_of(options), box, options.samples_expected()) {}

dem::Watch ProfileObserver::watch(const dem::ContactLaws& laws) {
  return {.first = options_.first_step,
          .last = options_.last_step,
          .every = options_.every,
          .plain = [this, &laws](const dem::DemState& state) { profile_.add(state, laws); },
          .fast_before = [this](const dem::fast::Engine& engine) { profile_.before(engine); },
          .fast_contacts = [this](const dem::fast::Engine&, std::size_t section,
                                  dem::fast::ContactPacks contacts) { profile_.add(section, contacts); },
          .fast = [this](const dem::fast::Engine& engine) { profile_.add(engine); }};
}

}  // namespace bagnold::cg

// What `check` prints: the table of contact types, and whether the start makes physical sense.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "dem/contact_laws.hpp"
#include "dem/contact_model.hpp"
#include "dem/energy.hpp"
#include "dem/step_limit.hpp"

namespace bagnold::dem {

namespace {

// The mean grain of a species, and in which roles the species occurs.
struct Occurrence {
  double mass = 0, radius = 0;
  std::int64_t count = 0, fixed = 0;
  bool wall = false;
  bool moves() const { return count > 0; }
};

std::vector<Occurrence> occurrences(const DemState& state, std::size_t species) {
  std::vector<Occurrence> found(species);
  const Grains& g = state.grains;
  std::vector<double> fixed_radius(species, 0.0);
  for (std::int64_t i = 0; i < g.size(); ++i) {
    Occurrence& o = found[at(g.species[at(i)])];
    if (i >= g.flowing) {
      ++o.fixed;
      fixed_radius[at(g.species[at(i)])] += 0.5 * g.diameter[at(i)];
      continue;
    }
    ++o.count;
    o.mass += g.mass[at(i)];
    o.radius += 0.5 * g.diameter[at(i)];
  }
  for (std::size_t s = 0; s < species; ++s) {
    Occurrence& o = found[s];
    if (o.count > 0) {
      o.mass /= static_cast<double>(o.count);
      o.radius /= static_cast<double>(o.count);
    } else if (o.fixed > 0) {
      o.radius = fixed_radius[s] / static_cast<double>(o.fixed);
    }
  }
  for (const Wall& wall : state.walls) found[at(wall.species)].wall = true;
  return found;
}

template <class Law>
ContactType describe(const Law& law, const Size& size, const ContactModel& model, std::size_t a, std::size_t b) {
  const auto normal = law.normal.respond(0.01 * size.reduced_radius, size);
  const laws::Collision collision = law.normal.collision(size);
  return {.a = model.species[a],
          .b = model.species[b],
          .reduced_mass = size.reduced_mass(),
          .kn = normal.stiffness,
          .gamma_n = normal.damping,
          .kt = law.tangential.stiffness(normal),
          .gamma_t = law.tangential.damping(normal),
          .mu = law.tangential.mu,
          .tc = collision.time,
          .restitution = collision.restitution};
}

}  // namespace

std::vector<ContactType> contact_types(const DemState& state, const ContactModel& model) {
  const auto found = occurrences(state, model.species.size());
  const ContactLaws laws = compile(model, mean_pair_mass(state.grains));
  std::vector<ContactType> types;
  with_laws(laws, [&](const auto& tables) {
    for (std::size_t a = 0; a < found.size(); ++a)
      for (std::size_t b = 0; b < found.size(); ++b) {
        const Occurrence &i = found[a], &j = found[b];
        if (!i.moves() || (j.moves() && b < a)) continue;  // fixed bodies never meet
        if (!j.moves() && j.fixed == 0 && !j.wall) continue;
        const Size size =
            laws::sizes(1 / i.radius, j.radius > 0 ? 1 / j.radius : 0.0, 1 / i.mass, j.moves() ? 1 / j.mass : 0.0);
        types.push_back(
            describe(tables.of(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)), size, model, a, b));
      }
  });
  return types;
}

std::vector<Finding> overlap_findings(const DemState& state) {
  const double overlap = max_overlap_over_radius(state);
  if (overlap <= 0.01) return {};
  return {
      {overlap > 0.1, "scenario",
       fmt::format("grains overlap at the start by up to {:.2g} of a radius, expected at most 0.1: the springs would "
                   "fling them apart",
                   overlap)}};
}

std::vector<Finding> physical_findings(const DemState& state, const ContactModel& model) {
  std::vector<Finding> findings = step_findings(state, model);
  for (Finding& finding : overlap_findings(state)) findings.push_back(std::move(finding));
  return findings;
}

}  // namespace bagnold::dem

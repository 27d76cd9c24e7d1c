#include "dem/step_limit.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dem/contact_laws.hpp"

namespace bagnold::dem {

namespace {

// The grains of a species: the mean flowing one, the extremes, and whether a wall is of it.
struct Extremes {
  double mass = 0, radius = 0;
  std::int64_t flowing = 0, fixed = 0;
  std::int64_t lightest = -1, second = -1, heaviest = -1;
  double smallest_fixed = INFINITY, largest_fixed = 0;  // radius
  bool wall = false;
};

void add_flowing(Extremes& e, const Grains& g, std::int64_t i) {
  ++e.flowing;
  e.mass += g.mass[at(i)];
  e.radius += 0.5 * g.diameter[at(i)];
  const auto lighter = [&](std::int64_t than) { return than < 0 || g.mass[at(i)] < g.mass[at(than)]; };
  if (lighter(e.lightest)) {
    e.second = e.lightest;
    e.lightest = i;
  } else if (lighter(e.second)) {
    e.second = i;
  }
  if (e.heaviest < 0 || g.mass[at(i)] > g.mass[at(e.heaviest)]) e.heaviest = i;
}

std::vector<Extremes> extremes(const DemState& state, std::size_t species) {
  std::vector<Extremes> found(species);
  const Grains& g = state.grains;
  for (std::int64_t i = 0; i < g.size(); ++i) {
    Extremes& e = found[at(g.species[at(i)])];
    if (i < g.flowing) {
      add_flowing(e, g, i);
      continue;
    }
    ++e.fixed;
    e.smallest_fixed = std::min(e.smallest_fixed, 0.5 * g.diameter[at(i)]);
    e.largest_fixed = std::max(e.largest_fixed, 0.5 * g.diameter[at(i)]);
  }
  for (Extremes& e : found)
    if (e.flowing > 0) {
      e.mass /= static_cast<double>(e.flowing);
      e.radius /= static_cast<double>(e.flowing);
    }
  for (const Wall& wall : state.walls) found[at(wall.species)].wall = true;
  return found;
}

// One of two bodies in contact. Infinite mass: it never moves; infinite radius: a wall.
struct Body {
  double radius = INFINITY, mass = INFINITY;
};

// Flowing grain i; the mean grain where that is the same but for the rounding of the mean, so that the table of contact
// types and the step agree to the last bit.
Body body_of(const Grains& g, std::int64_t i, const Extremes& e) {
  const Body own{0.5 * g.diameter[at(i)], g.mass[at(i)]}, mean{e.radius, e.mass};
  const bool same = std::abs(own.mass / mean.mass - 1) < 1e-12 && std::abs(own.radius / mean.radius - 1) < 1e-12;
  return same ? mean : own;
}

// The partners of the lightest grain of species `a` among which the limiting one is. A linear spring is the faster the
// lighter they are; at a given relative overlap the rate of a Hertz contact goes with
// (1/m_i + 1/m_j)/(1/r_i + 1/r_j), which is largest for the lightest or for the heaviest. A grain without another of its
// species counts as two.
std::vector<Body> partners(const Grains& g, const Extremes& a, const Extremes& b, bool same_species) {
  std::vector<Body> out;
  if (b.flowing > 0) out.push_back(body_of(g, same_species && b.second >= 0 ? b.second : b.lightest, b));
  if (b.flowing > 0 && b.heaviest != a.lightest) out.push_back(body_of(g, b.heaviest, b));
  if (b.fixed > 0) {
    out.push_back({.radius = b.smallest_fixed});
    out.push_back({.radius = b.largest_fixed});
  }
  if (b.wall) out.push_back({});
  return out;
}

// Largest stable step of v += -dt (k x + c v)/m, x += dt v: with w^2 = k/m and r = c/(2 m) the roots of
// z^2 - (2 - 2 r dt - w^2 dt^2) z + 1 - 2 r dt lie within the unit circle while w^2 dt^2 + 4 r dt < 4.
double stable_step(double stiffness, double damping, double mass) {
  const double rate = damping / (2 * mass);
  return 2 / (rate + std::sqrt(rate * rate + stiffness / mass));
}

// tc, stable and step of a pair, at an overlap of 1 % of the reduced radius where they depend on it, as in ContactType.
template <class Law>
StepLimit limit_of(const Law& law, const Size& size) {
  const auto normal = law.normal.respond(0.01 * size.reduced_radius, size);
  const double kt = law.tangential.stiffness(normal), gamma_t = law.tangential.damping(normal);
  const double m = size.reduced_mass();
  constexpr double spin = 3.5;  // a solid sphere pushed at its surface gives way like 2/7 of its mass
  StepLimit limit;
  limit.tc = law.normal.collision(size).time;
  limit.stable = std::min(stable_step(normal.stiffness, normal.damping, m), stable_step(spin * kt, spin * gamma_t, m));
  limit.step = std::min(limit.tc / 50, limit.stable / 5);
  return limit;
}

}  // namespace

StepLimit step_limit(const DemState& state, const ContactModel& model) {
  const auto found = extremes(state, model.species.size());
  const ContactLaws laws = compile(model, mean_pair_mass(state.grains));
  StepLimit limit{.step = INFINITY};
  with_laws(laws, [&](const auto& tables) {
    for (std::size_t a = 0; a < found.size(); ++a) {
      if (found[a].flowing == 0) continue;
      const Body first = body_of(state.grains, found[a].lightest, found[a]);
      for (std::size_t b = 0; b < found.size(); ++b)
        for (const Body& second : partners(state.grains, found[a], found[b], a == b)) {
          const Size size = laws::sizes(1 / first.radius, 1 / second.radius, 1 / first.mass, 1 / second.mass);
          StepLimit here = limit_of(tables.of(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)), size);
          if (here.step >= limit.step) continue;
          here.a = model.species[a];
          here.b = model.species[b];
          here.diameter_a = 2 * first.radius;
          here.diameter_b = std::isfinite(second.radius) ? 2 * second.radius : 0;
          limit = here;
        }
    }
  });
  return limit;
}

std::string to_string(const StepLimit& limit) {
  const std::string first = fmt::format("{}-{}, d = {:.4g}", limit.a, limit.b, limit.diameter_a);
  return first + (limit.diameter_b == 0 ? " at a plane" : fmt::format(" and {:.4g}", limit.diameter_b));
}

std::vector<Finding> step_findings(const DemState& state, const ContactModel& model) {
  if (state.grains.flowing == 0) return {{true, "scenario", "there are no moving grains"}};
  std::vector<Finding> findings;
  for (const ContactType& type : contact_types(state, model))
    if (!std::isfinite(type.tc))
      findings.push_back(
          {false, "contact.damping", fmt::format("{}-{} is overdamped and never rebounds", type.a, type.b)});
  const StepLimit limit = step_limit(state, model);
  const double steps = 50 * limit.step / state.dt;  // per collision
  if (steps >= 20 * (1 - 1e-9)) return findings;
  const bool error = steps < 10 * (1 - 1e-9);
  const std::string pair = to_string(limit);
  findings.push_back(
      {error, "time.step",
       limit.by_dashpots()
           ? fmt::format("{:g} is {:.3g} of the largest stable step {:g} of {}; expected at most {} (1/5 is usual)",
                         state.dt, state.dt / limit.stable, limit.stable, pair, error ? "1" : "1/2")
           : fmt::format("{:g} is 1/{:.3g} of the collision time {:g} of {}; expected at most 1/{} (1/50 is usual)",
                         state.dt, steps, limit.tc, pair, error ? 10 : 20)});
  return findings;
}

}  // namespace bagnold::dem

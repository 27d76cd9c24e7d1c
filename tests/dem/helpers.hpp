// States for tests.
#pragma once
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "dem/algorithm.hpp"
#include "dem/contact_model.hpp"
#include "dem/energy.hpp"

namespace bagnold::dem::testing {

inline void add_grain(DemState& s, Vec3 x, Vec3 v = {}, Vec3 omega = {}, double d = 1,
                      double density = 6 / std::numbers::pi, std::int32_t species = 0) {
  Grains& g = s.grains;
  g.x.push_back(x);
  g.v.push_back(v);
  g.omega.push_back(omega);
  g.diameter.push_back(d);
  g.mass.push_back(density * std::numbers::pi / 6 * d * d * d);
  g.inertia.push_back(0.1 * g.mass.back() * d * d);
  g.species.push_back(species);
  g.id.push_back(static_cast<std::int64_t>(g.id.size()));
  ++g.flowing;
}

inline laws::Linear linear(double kn, double gamma) {
  laws::Linear law;
  law.stiffness = kn;
  law.damping = gamma;
  return law;
}

// The paper's constants: kn = 2e5, gamma_n = gamma_t = 25, kt = 2/7 kn, mu = 1/2.
inline ContactLaws paper_laws(double gamma = 25, double mu = 0.5) {
  laws::LinearHistory tangential;
  tangential.friction = mu;
  return compile(uniform_model({"grain"}, {linear(2e5, gamma), tangential, laws::NoRollingResistance{}}), 0.5);
}

// `n` grains at random in a periodic box at about the given volume fraction, overlapping little or not at all:
// a perturbed cubic lattice with random diameters and velocities.
inline DemState random_packing(std::int64_t per_side, double spacing, std::uint64_t seed, double size_spread = 0.3) {
  DemState s;
  s.box = {.origin = {-1, 2, 0},
           .length = Vec3{1, 1, 1} * (spacing * static_cast<double>(per_side)),
           .periodic = {true, true, true}};
  std::uint64_t item = 0;
  const auto u = [&](std::uint32_t draw) { return 2 * random::uniform(seed, random::Stream::test, item, draw) - 1; };
  for (std::int64_t a = 0; a < per_side; ++a)
    for (std::int64_t b = 0; b < per_side; ++b)
      for (std::int64_t c = 0; c < per_side; ++c, ++item) {
        const Vec3 site{static_cast<double>(a), static_cast<double>(b), static_cast<double>(c)};
        const Vec3 x = s.box.origin + spacing * site + 0.04 * Vec3{u(0), u(1), u(2)};
        add_grain(s, x, {u(3), u(4), u(5)}, {2 * u(6), 2 * u(7), 2 * u(8)}, 1 + 0.5 * size_spread * (u(9) - 1));
      }
  return s;
}

// All arrays of a state as bytes.
inline std::string bits(DemState& s) {
  std::string out;
  for (const NamedArray& named : named_arrays(s))
    std::visit(
        [&](auto* a) {
          if constexpr (requires { a->data(); })
            out.append(reinterpret_cast<const char*>(a->data()), a->size() * sizeof(*a->data()));
          else
            out.append(reinterpret_cast<const char*>(a), sizeof *a);
        },
        named.array);
  return out;
}

}  // namespace bagnold::dem::testing

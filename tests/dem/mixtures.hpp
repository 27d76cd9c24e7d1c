// Every kind of law with equal and unequal grains and several species, for tests of one engine against another.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "helpers.hpp"

namespace bagnold::dem::testing {

inline PairParameters hertz_mindlin() {
  laws::Hertz normal;
  normal.young_modulus = 5e6;
  normal.restitution = 0.88;
  return {normal, laws::Mindlin{}, laws::NoRollingResistance{}};
}

// A choice of laws and sizes.
struct Mixture {
  std::string name;
  double size_spread;
  ContactLaws laws;
  int species = 1;
};

inline std::vector<Mixture> mixtures() {
  const PairParameters paper{linear(2e5, 25), laws::LinearHistory{}, laws::NoRollingResistance{}};
  PairParameters per_mass = paper, rolling = paper, hertz_rolling = hertz_mindlin();
  auto silbert = linear(2e5, 50);
  silbert.damping_convention = "per_reduced_mass";
  laws::LinearHistory damped;
  damped.tangential_damping = 25;
  per_mass.normal = silbert;
  per_mass.tangential = damped;
  rolling.rolling = hertz_rolling.rolling = laws::SpringSlider{};
  auto two = uniform_model({"a", "b"}, paper);
  PairParameters other = paper;
  other.normal = linear(1e5, 10);
  set_pair(two, 0, 1, other);
  const auto one = [](const PairParameters& p) { return compile(uniform_model({"grain"}, p), 0.5); };
  return {{"paper", 0, one(paper)},
          {"polydisperse", 0.4, one(paper)},
          {"hertz", 0, one(hertz_mindlin())},
          {"hertz polydisperse", 0.4, one(hertz_mindlin())},
          {"rolling", 0.3, one(rolling)},
          {"per mass", 0.3, one(per_mass)},
          {"hertz rolling", 0, one(hertz_rolling)},
          {"species", 0.2, compile(two, 0.5), 2}};
}

inline double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, norm(a[i] - b[i]));
  return largest;
}

}  // namespace bagnold::dem::testing

// Which law acts between which species. A ContactModel is the input as written; compile() turns it into the tables
// of constants that the force loop reads.
#pragma once
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "dem/state.hpp"
#include "laws/registries.hpp"

namespace bagnold::dem {

// The laws of one pair of species. Within a model every pair has the same kinds of law, with its own parameters.
struct PairParameters {
  laws::NormalLaws::Any normal;
  laws::TangentialLaws::Any tangential;
  laws::RollingLaws::Any rolling;
};

struct ContactModel {
  std::vector<std::string> species;   // names; Grains::species and Wall::species index them
  std::vector<PairParameters> pairs;  // symmetric: entry a * species.size() + b
};

// Every pair of the named species with the same parameters; overwrite entries of `pairs` with set_pair.
ContactModel uniform_model(std::vector<std::string> species, const PairParameters& parameters);
void set_pair(ContactModel& model, std::int32_t a, std::int32_t b, const PairParameters& parameters);

namespace detail {
template <class... Variants>
struct Joined;
template <class... A>
struct Joined<std::variant<A...>> {
  using Tables = std::variant<std::vector<A>...>;
};
template <class... A, class... B, class... Rest>
struct Joined<std::variant<A...>, std::variant<B...>, Rest...> : Joined<std::variant<A..., B...>, Rest...> {};
template <class R>
struct TablesOf;
template <class... Laws>
struct TablesOf<Registry<Laws...>> : Joined<typename Laws::Constants...> {};
}  // namespace detail

// For a registry of laws: one vector of constants, by species pair (entry a * species + b), of whichever law is chosen.
template <class R>
using Tables = typename detail::TablesOf<R>::Tables;

struct ContactLaws {
  std::int32_t species = 0;
  Tables<laws::NormalLaws> normal;
  Tables<laws::TangentialLaws> tangential;
  Tables<laws::RollingLaws> rolling;
};

// `pair_mass`: reduced mass of two mean flowing grains (mean_pair_mass), at which (collision_time, restitution) and
// the automatic tangential damping hold when the input does not state another.
// Throws UnphysicalError for parameters out of range, mixed kinds of law, or an automatic value that has no meaning.
ContactLaws compile(const ContactModel& model, double pair_mass);

double mean_pair_mass(const Grains& grains);  // m/2 of the mean flowing grain

// One line of the table of contact types: what a pair of species amounts to at its own masses.
struct ContactType {
  std::string a, b;
  double reduced_mass = 0;     // of mean grains; the grain's own mass against a base or a wall
  double kn = 0, gamma_n = 0;  // damping as a force: f = kn delta - gamma_n v. For Hertz: tangent values at
  double kt = 0, gamma_t = 0;  // an overlap of 1 % of the reduced radius
  double mu = 0;
  double tc = 0, restitution = 0;  // for Hertz: tc of impact at which the overlap would reach that 1 %
};
std::vector<ContactType> contact_types(const DemState& state, const ContactModel& model);

// What `check` says of a step and a start.
struct Finding {
  bool error = false;  // otherwise a warning
  std::string key, text;
};
// Of a prepared state: what step_findings (dem/step_limit.hpp) says, and overlaps at the start: > 1 % of the smaller
// radius a warning, > 10 % an error.
std::vector<Finding> physical_findings(const DemState& state, const ContactModel& model);

}  // namespace bagnold::dem

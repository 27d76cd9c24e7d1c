// How long a step may be: the pair of bodies that decides it, and what is said of a step that is too long.
#pragma once
#include <string>
#include <vector>

#include "dem/contact_model.hpp"
#include "dem/state.hpp"

namespace bagnold::dem {

// Of all pairs of bodies that exist and can meet, the lightest, stiffest one.
struct StepLimit {
  std::string a, b;                       // species
  double diameter_a = 0, diameter_b = 0;  // 0: a wall
  double tc = 0;                          // its collision time; infinite when it is overdamped
  double stable = 0;                      // largest stable step of its springs and dashpots
  double step = 0;                        // tc/50, at most stable/5
  bool by_dashpots() const { return tc / 50 > step; }
};
StepLimit step_limit(const DemState& state, const ContactModel& model);
std::string to_string(const StepLimit& limit);  // "grain-grain, d = 0.1 and 0.12"

// dt of the state against the limiting pair: beyond tc/10 or the largest stable step an error, beyond half of that a
// warning. Also overdamped contact types (warning) and a state in which nothing moves (error).
std::vector<Finding> step_findings(const DemState& state, const ContactModel& model);
// Overlaps of a prepared state: more than 1 % of the smaller radius is a warning, more than 10 % an error.
std::vector<Finding> overlap_findings(const DemState& state);

}  // namespace bagnold::dem

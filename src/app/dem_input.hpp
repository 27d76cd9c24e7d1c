// A case of the particle model, read: the initial state, the contact model and when to stop.
#pragma once
#include <string>
#include <tuple>
#include <vector>

#include "config/case.hpp"
#include "dem/algorithm.hpp"
#include "dem/contact_model.hpp"
#include "dem/step_limit.hpp"

namespace bagnold::app {

struct DemInput {
  std::string scenario;
  dem::DemState state;  // prepared: ready to step
  dem::ContactModel model;
  dem::ContactLaws laws;
  dem::StepLimit limit;  // the pair that decides the automatic step
  double end = 0;
  bool stop_when_arrested = false;
  double gravity = 0;                                          // magnitude
  double angle_deg = 0, base_size_ratio = 0, fill_height = 0;  // chute only
  double column_radius = 0, column_height = 0;                 // column and heap only
  double diameter = 1, density = 1;                            // of the mean flowing grain
  std::vector<std::string> warnings;
};

struct DemTime {
  static constexpr std::string_view name = "time";
  static constexpr std::string_view summary = "how long a run lasts and how finely it steps";
  double end = 0;
  std::optional<double> step;
  bool stop_when_arrested = true;
  static constexpr auto fields() {
    return std::tuple{
        required("end", "time", "when the run ends", &DemTime::end, positive()),
        field("step", "time", "auto: tc/50 of the lightest, stiffest pair that can meet", &DemTime::step, positive()),
        field("stop_when_arrested", "", "end earlier when everything is at rest (scenario grains: default false)",
              &DemTime::stop_when_arrested)};
  }
};

// Throws InputError at the place in the case of whatever is wrong or unphysical.
DemInput read_dem(config::Case& input);

}  // namespace bagnold::app

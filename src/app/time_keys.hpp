// How long a continuum run lasts. (Grains have a step of their own: DemTime.)
#pragma once
#include <string_view>

#include "core/fields.hpp"

namespace bagnold::app {

struct TimeKeys {
  static constexpr std::string_view name = "time";
  static constexpr std::string_view summary = "how long a run lasts; its step follows from the limits of the scheme";
  double end = 0;
  bool stop_when_arrested = true;
  static constexpr auto fields() {
    return std::tuple{
        required("end", "time", "when the run ends", &TimeKeys::end, positive()),
        field("stop_when_arrested", "", "end earlier when everything is at rest", &TimeKeys::stop_when_arrested)};
  }
};

}  // namespace bagnold::app

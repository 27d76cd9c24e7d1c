// Mean density that falls with the angle of the friction.
#pragma once
#include <cmath>
#include <string_view>
#include <tuple>

#include "core/fields.hpp"

namespace bagnold::laws {

// Eq. 52a is misprinted: c1 divides the exponent, rho/rho_p = c0 - exp((theta - c2)/c1) (0.569 at 24 deg, 0.514 at 29 deg).
struct ExponentialAngleDensity {
  static constexpr std::string_view name = "exponential-angle";
  static constexpr std::string_view summary = "rho/rho_p = c0 - exp((theta - c2)/c1), theta = atan(mu)";
  static constexpr std::string_view source = "Weinhart et al. 2012, eq. 52";
  double c0 = 0.5985, c1_deg = 4.8, c2_deg = 40.85;

  static constexpr auto fields() {
    using L = ExponentialAngleDensity;
    return std::tuple{
        field("c0", "1", "volume fraction of slow flow", &L::c0, Range{.lo = 0, .hi = 1, .lo_open = true}),
        field("c1_deg", "deg", "angle over which the flow dilates", &L::c1_deg, positive()),
        field("c2_deg", "deg", "angle at which the dilation reaches 1", &L::c2_deg)};
  }
  double volume_fraction(double theta_deg) const { return c0 - std::exp((theta_deg - c2_deg) / c1_deg); }
};

}  // namespace bagnold::laws

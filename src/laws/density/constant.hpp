// Constant mean density of the flowing layer.
#pragma once
#include <string_view>
#include <tuple>

#include "core/fields.hpp"

namespace bagnold::laws {

struct ConstantDensity {
  static constexpr std::string_view name = "constant";
  static constexpr std::string_view summary = "rho/rho_p = phi";
  static constexpr std::string_view source = "incompressible flow";
  double phi = 0.58;

  static constexpr auto fields() {
    return std::tuple{
        field("phi", "1", "solid volume fraction", &ConstantDensity::phi, Range{.lo = 0, .hi = 1, .lo_open = true})};
  }
  double volume_fraction(double /*theta_deg*/) const { return phi; }
};

}  // namespace bagnold::laws

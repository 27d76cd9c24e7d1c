// Ratio of the normal stresses, linear in the angle of the friction.
#pragma once
#include <string_view>
#include <tuple>

#include "core/fields.hpp"

namespace bagnold::laws {

struct LinearAngleStressRatio {
  static constexpr std::string_view name = "linear-angle";
  static constexpr std::string_view summary = "K = sigma_xx/sigma_zz = 1 + (theta - d1)/d0, theta = atan(mu)";
  static constexpr std::string_view source = "Weinhart et al. 2012, eq. 53";
  double d0_deg = 132, d1_deg = 21.50;

  static constexpr auto fields() {
    using L = LinearAngleStressRatio;
    return std::tuple{field("d0_deg", "deg", "angle over which K grows by one", &L::d0_deg, positive()),
                      field("d1_deg", "deg", "angle of isotropic stress", &L::d1_deg)};
  }
  double ratio(double theta_deg) const { return 1 + (theta_deg - d1_deg) / d0_deg; }
};

}  // namespace bagnold::laws

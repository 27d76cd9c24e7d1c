// Constant ratio of the normal stresses.
#pragma once
#include <string_view>
#include <tuple>

#include "core/fields.hpp"

namespace bagnold::laws {

struct ConstantStressRatio {
  static constexpr std::string_view name = "constant";
  static constexpr std::string_view summary = "sigma_xx/sigma_zz = K";
  static constexpr std::string_view source = "Weinhart et al. 2012, section 9.2: K close to 1";
  double K = 1;

  static constexpr auto fields() {
    return std::tuple{field("K", "1", "ratio of the normal stresses", &ConstantStressRatio::K, positive())};
  }
  double ratio(double /*theta_deg*/) const { return K; }
};

}  // namespace bagnold::laws

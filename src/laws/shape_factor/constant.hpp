// Constant shape factor of the velocity profile.
#pragma once
#include <string_view>
#include <tuple>

#include "core/fields.hpp"

namespace bagnold::laws {

struct ConstantShapeFactor {
  static constexpr std::string_view name = "constant";
  static constexpr std::string_view summary =
      "alpha = mean(u^2)/mean(u)^2: 1 plug, 1.2 parabolic, 1.25 Bagnold, 4/3 linear";
  static constexpr std::string_view source = "Weinhart et al. 2012, section 4.1 and table 2";
  double alpha = 1;

  static constexpr auto fields() {
    return std::tuple{field("alpha", "1", "shape factor", &ConstantShapeFactor::alpha, at_least(1))};
  }
  static constexpr bool is_constant = true;
  double factor(double /*h*/, double /*mu*/) const { return alpha; }
};

}  // namespace bagnold::laws

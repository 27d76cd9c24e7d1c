// Mean viscosity of two particles.
#pragma once
#include <string_view>

#include "core/fields.hpp"
#include "core/numeric.hpp"

namespace bagnold::laws::mean {

struct Arithmetic {
  static constexpr std::string_view name = "arithmetic";
  static constexpr std::string_view summary = "(a + b)/2";
  static constexpr std::string_view source = "plain average";
  static constexpr auto fields() { return std::tuple<>{}; }
  // The mean of a and b over a divisor, in one division.
  template <class T>
  static T over(T divisor, T a, T b) {
    return 0.5 * (a + b) / divisor;
  }
};

}  // namespace bagnold::laws::mean

// Mean viscosity of two particles.
#pragma once
#include <cmath>
#include <string_view>

#include "core/fields.hpp"
#include "core/numeric.hpp"

namespace bagnold::laws::mean {

struct Geometric {
  static constexpr std::string_view name = "geometric";
  static constexpr std::string_view summary = "sqrt(a b)";
  static constexpr std::string_view source = "plain average of logarithms";
  static constexpr auto fields() { return std::tuple<>{}; }
  // The mean of a and b over a divisor, in one division.
  template <class T>
  static T over(T divisor, T a, T b) {
    return sqrt(T(a * b)) / divisor;
  }
};

}  // namespace bagnold::laws::mean

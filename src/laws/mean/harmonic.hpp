// Mean viscosity of two particles.
#pragma once
#include <string_view>

#include "core/fields.hpp"
#include "core/numeric.hpp"

namespace bagnold::laws::mean {

struct Harmonic {
  static constexpr std::string_view name = "minatti2015";
  static constexpr std::string_view summary = "2 a b/(a + b): the smaller viscosity decides";
  static constexpr std::string_view source = "Cleary 1998; Minatti & Paris 2015, eq. 27";
  static constexpr auto fields() { return std::tuple<>{}; }
  // The mean of a and b over a divisor, in one division.
  template <class T>
  static T over(T divisor, T a, T b) {
    return 2 * a * b / max(T((a + b) * divisor), T(1e-300));
  }
};

}  // namespace bagnold::laws::mean

// Constant basal friction: mu = tan(delta).
#pragma once
#include <cmath>
#include <numbers>
#include <string_view>
#include <tuple>

#include "core/fields.hpp"
#include "core/numeric.hpp"

namespace bagnold::laws {

// Friction and its derivative with respect to the Froude number. N: double, or a pack of numbers, here and in every law.
template <class N>
struct MuAndSlopeOf {
  N mu, slope;
};
using MuAndSlope = MuAndSlopeOf<double>;

inline double tan_deg(double angle_deg) { return std::tan(angle_deg * std::numbers::pi / 180); }

struct Coulomb {
  static constexpr std::string_view name = "coulomb";
  static constexpr std::string_view summary = "constant basal friction: mu = tan(delta)";
  static constexpr std::string_view source = "Weinhart et al. 2012, section 4.2 (limit delta1 = delta2 of eq. 37)";
  double delta_deg = 20;

  static constexpr auto fields() {
    return std::tuple{field("delta_deg", "deg", "basal friction angle", &Coulomb::delta_deg,
                            Range{.lo = 0, .hi = 90, .hi_open = true})};
  }

  // The law with its tangents taken, for loops. h: thickness (any unit of length), F = |u|/sqrt(g h cos theta).
  struct Prepared {
    double tan_delta;
    template <class N>
    N mu(const N& /*h*/, const N& /*F*/) const {
      return tan_delta;
    }
    template <class N>
    MuAndSlopeOf<N> mu_and_slope(const N& /*h*/, const N& /*F*/) const {
      return {tan_delta, 0.0};
    }
  };
  Prepared prepared(double /*g*/) const { return {tan_deg(delta_deg)}; }
};

}  // namespace bagnold::laws

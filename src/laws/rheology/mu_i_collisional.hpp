// Friction beyond the dense regime.
#pragma once
#include <cmath>
#include <string_view>

#include "core/fields.hpp"

namespace bagnold::laws::rheology {

// mu(i) = (mu_s i0 + mu_2 i + mu_inf i^2)/(i0 + i)                        Barker & Gray 2017
// Dense mu(i) for small i; collisions make friction grow with i for i > 0.3 instead of saturating at mu_2.
struct MuICollisional {
  static constexpr std::string_view name = "collisional";
  static constexpr std::string_view summary =
      "mu(i) = (mu_s i0 + mu_2 i + mu_inf i^2)/(i0 + i): grows with i beyond 0.3";
  static constexpr std::string_view source = "Barker & Gray 2017, J. Fluid Mech. 828, 5-32";
  double static_angle_deg = 30.5, limit_angle_deg = 51.3, i0 = 2.65, mu_inf = 0.05;
  static constexpr auto fields() {
    using S = MuICollisional;
    return std::tuple{
        field("static_angle_deg", "deg", "atan(mu_s), friction angle at rest", &S::static_angle_deg, open(0, 89)),
        field("limit_angle_deg", "deg", "atan(mu_2), as in the dense law", &S::limit_angle_deg, open(0, 89)),
        field("i0", "", "inertial number of the dense law", &S::i0, positive()),
        field("mu_inf", "", "slope of mu(i) at large i", &S::mu_inf, non_negative())};
  }
  double static_friction() const { return std::tan(static_angle_deg * M_PI / 180); }
  double limit_friction() const { return std::tan(limit_angle_deg * M_PI / 180); }
  struct Excess {
    double span, i0, mu_inf;
    template <class T>
    T operator()(T i) const {
      return (span + mu_inf * i) / (i0 + i);
    }
  };
  Excess excess() const { return {limit_friction() - static_friction(), i0, mu_inf}; }
  double mu(double i) const { return static_friction() + i * excess()(i); }
};

}  // namespace bagnold::laws::rheology

// Friction of dense granular flow.
#pragma once
#include <cmath>
#include <string_view>

#include "core/fields.hpp"

namespace bagnold::laws::rheology {

// mu(i) = mu_s + (mu_2 - mu_s)/(1 + i0/i)                                  Minatti & Paris 2015, eq. 7
struct MuI {
  static constexpr std::string_view name = "minatti2015";
  static constexpr std::string_view summary = "mu(i) = mu_s + (mu_2 - mu_s)/(1 + i0/i), dense regime (i <= 0.3)";
  static constexpr std::string_view source = "Minatti & Paris 2015, eq. 7; Jop et al. 2006";
  double static_angle_deg = 30.5, limit_angle_deg = 51.3, i0 = 2.65;
  static constexpr auto fields() {
    return std::tuple{
        field("static_angle_deg", "deg", "atan(mu_s), friction angle at rest", &MuI::static_angle_deg, open(0, 89)),
        field("limit_angle_deg", "deg", "atan(mu_2), friction angle at large i", &MuI::limit_angle_deg, open(0, 89)),
        field("i0", "", "inertial number half-way between the two", &MuI::i0, positive())};
  }
  double static_friction() const { return std::tan(static_angle_deg * M_PI / 180); }
  double limit_friction() const { return std::tan(limit_angle_deg * M_PI / 180); }
  // (mu(i) - mu_s)/i, finite at i = 0: what the viscosity beyond yield needs.
  struct Excess {
    double span, i0;
    template <class T>
    T operator()(T i) const {
      return span / (i0 + i);
    }
  };
  Excess excess() const { return {limit_friction() - static_friction(), i0}; }
  double mu(double i) const { return static_friction() + i * excess()(i); }
};

}  // namespace bagnold::laws::rheology

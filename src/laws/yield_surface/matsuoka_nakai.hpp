// Shape of the yield surface in the deviatoric plane.
#pragma once
#include <string_view>

#include "core/fields.hpp"
#include "laws/yield_surface/smooth_cone.hpp"

namespace bagnold::laws::yield_surface {

// I1 I2/I3 = const, the value of plane strain.                              Matsuoka & Nakai 1974
// With I1 = 3p, I2 = 3p^2 - J2, I3 = p^3 - p J2 + J3, m = sqrt(J2)/p and J3 = (2/sqrt 27) cos(3 theta) J2^(3/2):
// 2 (m^2 - mu^2) = (3 - mu^2) (2/sqrt 27) cos(3 theta) m^3, a smooth cone with c = mu (3 - mu^2)/2.
struct MatsuokaNakai {
  static constexpr std::string_view name = "matsuoka_nakai";
  static constexpr std::string_view summary = "I1 I2/I3 = const: stronger in triaxial compression, weaker in extension";
  static constexpr std::string_view source = "Matsuoka & Nakai 1974, Proc. JSCE 232, 59-70";
  static constexpr auto fields() { return std::tuple<>{}; }
  using Shape = SmoothCone;
  static constexpr double largest_friction = 1;  // where the cone opens
  // mu: friction in plane strain, < 1.
  static Shape shape(double mu) { return {0.5 * mu * (3 - mu * mu)}; }
};

}  // namespace bagnold::laws::yield_surface

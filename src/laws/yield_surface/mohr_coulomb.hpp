// Shape of the yield surface in the deviatoric plane.
#pragma once
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/fields.hpp"

namespace bagnold::laws::yield_surface {

// (s1 - s3)/(s1 + s3) = sin(phi) whatever the stress between them, sin(phi) = mu being |tau|/p in plane shear.       Coulomb 1776
// With principal stresses p + (2/sqrt 3) m p cos(theta - 2 pi k/3), 0 <= theta <= pi/3 from triaxial compression to extension:
// m sin(theta + pi/3) = mu (1 + m cos(theta + pi/3)/sqrt 3), a hexagon.
struct MohrCoulomb {
  static constexpr std::string_view name = "mohr_coulomb";
  static constexpr std::string_view summary = "hexagon: one friction angle, that of plane shear, at every Lode angle";
  static constexpr std::string_view source = "Coulomb 1776; Mohr 1900";
  static constexpr auto fields() { return std::tuple<>{}; }
  struct Shape {
    static constexpr bool circular = false;
    double mu;
    double operator()(double cos_3_theta) const {
      const double angle = (std::acos(std::clamp(cos_3_theta, -1.0, 1.0)) + M_PI) / 3;  // theta + pi/3
      return 1 / (std::sin(angle) - mu * std::cos(angle) / std::sqrt(3.0));
    }
  };
  static constexpr double largest_friction = 1;  // sin(phi)
  // mu: friction in plane shear, < 1.
  static Shape shape(double mu) { return {mu}; }
};

}  // namespace bagnold::laws::yield_surface

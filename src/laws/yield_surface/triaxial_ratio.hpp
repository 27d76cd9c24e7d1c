// Shape of the yield surface in the deviatoric plane.
#pragma once
#include <string_view>

#include "core/fields.hpp"
#include "laws/yield_surface/smooth_cone.hpp"

namespace bagnold::laws::yield_surface {

// A smooth cone of given strength in triaxial compression: g = 1/triaxial_compression in 1 - g^2 = (2/sqrt 27) c/g. At every friction the
// same, so it can be measured once, by shearing grains in plane strain and compressing them along an axis.
struct TriaxialRatio {
  static constexpr std::string_view name = "triaxial_ratio";
  static constexpr std::string_view summary =
      "smooth cone of measured strength in triaxial compression; 1.13: columns of grains, "
      "validation/minatti2015/columns";
  static constexpr std::string_view source = "columns/grains-lode.csv; form of Matsuoka & Nakai 1974";
  double triaxial_compression = 1.13;
  static constexpr auto fields() {
    return std::tuple{field("triaxial_compression", "", "friction in triaxial compression over that in plane strain",
                            &TriaxialRatio::triaxial_compression, closed(1, 1.7))};  // a triangle at sqrt 3
  }
  using Shape = SmoothCone;
  static constexpr double largest_friction = 1e300;
  Shape shape(double) const {
    const double g = 1 / triaxial_compression;
    return {0.5 * std::sqrt(27.0) * (g - g * g * g)};
  }
};

}  // namespace bagnold::laws::yield_surface

// What cones f(I1, J2, J3) = const without corners have in common.
#pragma once
#include <algorithm>
#include <cmath>

namespace bagnold::laws::yield_surface {

// m/mu of a cone 1 - g^2 = (2/sqrt 27) c cos(3 theta)/g, g = mu/m, where mu is |tau|/p in plane strain (cos 3 theta = 0), m
// at the Lode angle theta: 1 in triaxial compression, compression being positive. With g = (2/sqrt 3) cos(psi) this is
// cos(3 psi) = -c cos(3 theta). Convex for 0 <= c <= 1: a circle at 0, a triangle at 1.
struct SmoothCone {
  static constexpr bool circular = false;
  double c;
  double operator()(double cos_3_theta) const {
    return 0.5 * std::sqrt(3.0) / std::cos(std::acos(std::clamp(-c * cos_3_theta, -1.0, 1.0)) / 3);
  }
};

}  // namespace bagnold::laws::yield_surface

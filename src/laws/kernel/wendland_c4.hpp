// Smoothing kernel of support 2h, smoother than C2.
#pragma once
#include <cmath>
#include <string_view>

#include "core/fields.hpp"
#include "core/numeric.hpp"

namespace bagnold::laws::kernel {

// W = a (1 - R/2)^6 (35/12 R^2 + 3R + 1), a = 9/(4 pi h^2) or 495/(256 pi h^3)
struct WendlandC4 {
  static constexpr std::string_view name = "wendland_c4";
  static constexpr std::string_view summary = "Wendland C4: a (1 - R/2)^6 (35/12 R^2 + 3R + 1), R = r/h < 2";
  static constexpr std::string_view source = "Wendland 1995; Dehnen & Aly 2012, table 1";
  static constexpr auto fields() { return std::tuple<>{}; }
  static double norm(int dimensions) { return dimensions == 2 ? 9 / (4 * M_PI) : 495 / (256 * M_PI); }
  static constexpr double slope_norm = 7.0 / 6;
  template <class T>
  static T value(T R) {
    const T t = max(T(1 - 0.5 * R), T(0)), t2 = t * t;
    return t2 * t2 * t2 * (35.0 / 12 * R * R + 3 * R + 1);
  }
  template <class T>
  static T slope(T weight, T R) {  // dW/dR = -(7/6) a (1 - R/2)^5 R (10 R + 4)
    const T t = max(T(1 - 0.5 * R), T(0)), t2 = t * t;
    return (t2 * t2) * (t * (weight * (10 * R + 4)));
  }
};

}  // namespace bagnold::laws::kernel

// Smoothing kernel of support 2h.
#pragma once
#include <cmath>
#include <string_view>

#include "core/fields.hpp"
#include "core/numeric.hpp"

namespace bagnold::laws::kernel {

// W = a (1 + 2R)(2 - R)^4, R = r/h < 2, a = 7/(64 pi h^2) or 21/(256 pi h^3)   Minatti & Paris 2015, eq. 20
struct WendlandC2 {
  static constexpr std::string_view name = "minatti2015";
  static constexpr std::string_view summary = "Wendland C2: a (1 + 2R)(2 - R)^4, R = r/h < 2";
  static constexpr std::string_view source = "Wendland 1995; Minatti & Paris 2015, eq. 20";
  static constexpr auto fields() { return std::tuple<>{}; }
  static double norm(int dimensions) { return dimensions == 2 ? 7 / (64 * M_PI) : 21 / (256 * M_PI); }
  // W h^D / norm, and -(dW/dR)/R h^D / (norm slope_norm) times a weight, in a short chain of products; zero beyond R = 2.
  static constexpr double slope_norm = 10;
  template <class T>
  static T value(T R) {
    const T t = max(T(2 - R), T(0)), t2 = t * t;
    return (1 + 2 * R) * t2 * t2;
  }
  template <class T>
  static T slope(T weight, T R) {
    const T t = max(T(2 - R), T(0));
    return (t * t) * (t * weight);
  }
};

}  // namespace bagnold::laws::kernel

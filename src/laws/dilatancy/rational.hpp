// Volume fraction beyond the dense regime.
#pragma once
#include <string_view>

#include "core/fields.hpp"
#include "laws/eos/cubic.hpp"

namespace bagnold::laws::dilatancy {

// phi(i) = phi_max/(1 + (1 - phi_min/phi_max) i): eq. 8 for small i, and positive for every i, so that a collisional
// layer dilutes instead of losing its pressure where the straight line meets zero. At large i it gives p ~ (rho d gamma)^2,
// the Bagnold scaling of kinetic theory.
struct Rational {
  static constexpr std::string_view name = "collisional";
  static constexpr std::string_view summary = "phi(i) = phi_max/(1 + (1 - phi_min/phi_max) i): positive for every i";
  static constexpr std::string_view source = "tangent to Minatti & Paris 2015, eq. 8, at i = 0";
  double phi_max = 0.6, phi_min = 0.5;
  static constexpr auto fields() {
    return std::tuple{
        field("phi_max", "", "volume fraction at rest", &Rational::phi_max, open(0, 1)),
        field("phi_min", "", "volume fraction the tangent at rest reaches at i = 1", &Rational::phi_min, open(0, 1))};
  }
  double phi(double i) const { return phi_max / (1 + (1 - phi_min / phi_max) * i); }

  // rho_s* = r (1 + s/y) with y = sqrt(rho_s* - 1): y^3 + (1 - r) y - s r = 0.
  template <class T>
  eos::Cubic<T> cubic(T r, T shear) const {
    const T s = shear * ((phi_max - phi_min) / phi_max), b = 1 - r;
    const T e = sqrt(T(max(T(-b), T(0))));
    return {.c2 = T(0), .c1 = b, .c0 = -s * r, .lower = e, .bulk = e};
  }
};

}  // namespace bagnold::laws::dilatancy

// Volume fraction of dense granular flow.
#pragma once
#include <string_view>

#include "core/fields.hpp"
#include "laws/eos/cubic.hpp"

namespace bagnold::laws::dilatancy {

// phi(i) = phi_max - (phi_max - phi_min) i                                 Minatti & Paris 2015, eq. 8
struct Linear {
  static constexpr std::string_view name = "minatti2015";
  static constexpr std::string_view summary = "phi(i) = phi_max - (phi_max - phi_min) i, dense regime (i <= 0.3)";
  static constexpr std::string_view source = "Minatti & Paris 2015, eq. 8; Pouliquen et al. 2006";
  double phi_max = 0.6, phi_min = 0.5;
  static constexpr auto fields() {
    return std::tuple{field("phi_max", "", "volume fraction at rest", &Linear::phi_max, open(0, 1)),
                      field("phi_min", "", "volume fraction at i = 1", &Linear::phi_min, open(0, 1))};
  }
  double phi(double i) const { return phi_max - (phi_max - phi_min) * i; }

  // Eq. 44 with y = sqrt(rho_s* - 1), divided by its double root: y^3 - s y^2 + (1 - r) y - s = 0, r = rho*/phi_max,
  // s = shear (phi_max - phi_min)/phi_max, shear = gamma d0 sqrt(Kt rho_s0), i = shear/y.
  template <class T>
  eos::Cubic<T> cubic(T r, T shear) const {
    const T s = shear * ((phi_max - phi_min) / phi_max), b = 1 - r;
    const T over = max(T(-b), T(0));
    return {.c2 = -s, .c1 = b, .c0 = -s, .lower = max(s, T(sqrt(over))), .bulk = 0.5 * (s + sqrt(T(s * s + 4 * over)))};
  }
};

}  // namespace bagnold::laws::dilatancy

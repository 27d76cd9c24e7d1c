// Coulomb friction plus a drag quadratic in the speed.
#pragma once
#include "laws/friction/coulomb.hpp"

namespace bagnold::laws {

// Basal stress tau/rho = mu g h cos(theta) + g u^2/xi, hence an apparent mu + u^2/(xi h cos(theta)) = mu + F^2 g/xi.
struct Voellmy {
  static constexpr std::string_view name = "voellmy";
  static constexpr std::string_view summary = "Coulomb friction with turbulent drag: mu = mu0 + F^2 g/xi";
  static constexpr std::string_view source = "Voellmy 1955; Christen, Kowalski & Bartelt 2010, eq. 8";
  double mu0 = 0.2, xi = 1000;

  static constexpr auto fields() {
    return std::tuple{field("mu0", "1", "dry friction coefficient", &Voellmy::mu0, non_negative()),
                      field("xi", "length/time^2", "turbulent friction coefficient", &Voellmy::xi, positive())};
  }

  struct Prepared {
    double mu0, g_per_xi;
    template <class N>
    N mu(const N& /*h*/, const N& F) const {
      return mu0 + g_per_xi * F * F;
    }
    template <class N>
    MuAndSlopeOf<N> mu_and_slope(const N& h, const N& F) const {
      return {mu(h, F), 2 * g_per_xi * F};
    }
  };
  Prepared prepared(double g) const { return {mu0, g / xi}; }
};

}  // namespace bagnold::laws

// Finite viscosity at rest, one time scale.
#pragma once
#include <string_view>

#include "core/exponential.hpp"
#include "core/fields.hpp"

namespace bagnold::laws::regularisation {

// eta = eta0 + tau_y (1 - exp(-m gamma))/gamma                              Minatti & Paris 2015, eq. 48
struct Papanastasiou {
  static constexpr std::string_view name = "papanastasiou";
  static constexpr std::string_view summary = "eta = eta0 + tau_y (1 - exp(-m gamma))/gamma with constant m";
  static constexpr std::string_view source = "Papanastasiou 1987; Minatti & Paris 2015, eq. 48";
  double m0 = 1.2;
  static constexpr auto fields() {
    return std::tuple{
        field("m0", "s", "time scale m; larger is closer to a yield stress", &Papanastasiou::m0, positive())};
  }
  template <class T>
  T viscosity(T tau_y, T eta0, T gamma) const {
    return eta0 + tau_y * m0 * one_minus_exp_over(T(m0 * gamma));
  }
};

}  // namespace bagnold::laws::regularisation

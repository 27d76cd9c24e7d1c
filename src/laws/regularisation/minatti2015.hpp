// Finite viscosity at rest, equal relative error at every yield stress.
#pragma once
#include <string_view>

#include "core/exponential.hpp"
#include "core/fields.hpp"

namespace bagnold::laws::regularisation {

// eta = eta0 + tau_y (1 - exp(-m_p gamma))/gamma, m_p(tau_y) from eq. 55    Minatti & Paris 2015, eqs 46-55
// With x = m0 gamma, exp(-m_p gamma) = exp(-x) tau0 (tau_y + eta0 gamma)/[tau_y (tau0 + eta0 gamma)], hence
//   tau_y (1 - exp(-m_p gamma))/gamma = tau_y m0 (1 - exp(-x))/x - exp(-x) eta0 (tau0 - tau_y)/(tau0 + eta0 gamma)
// without logarithm, division by tau_y or cancellation at rest. Clipped at 0, where m_p would be negative.
struct Minatti2015 {
  static constexpr std::string_view name = "minatti2015";
  static constexpr std::string_view summary =
      "Papanastasiou with m_p(tau_y), so that the error does not depend on yield stress";
  static constexpr std::string_view source = "Minatti & Paris 2015, eqs 46-55";
  double tau0 = 795, m0 = 1.2;
  static constexpr auto fields() {
    return std::tuple{
        field("tau0", "Pa", "largest yield stress expected", &Minatti2015::tau0, positive()),
        field("m0", "s", "m_p at tau0; larger is closer to a yield stress", &Minatti2015::m0, positive())};
  }
  // eta [Pa s] from yield stress tau_y [Pa], viscosity beyond yield eta0 [Pa s] and shear rate [1/s].
  template <class T>
  T viscosity(T tau_y, T eta0, T gamma) const {
    const T x = m0 * gamma, e = exp_negative(T(-x));
    const T g = tau_y * m0 * one_minus_exp_over(x, e) - e * eta0 * (tau0 - tau_y) * reciprocal(T(tau0 + eta0 * gamma));
    return eta0 + max(g, T(0));
  }
};

}  // namespace bagnold::laws::regularisation

// Finite viscosity at rest without an exponential.
#pragma once
#include <string_view>

#include "core/fields.hpp"

namespace bagnold::laws::regularisation {

// eta = eta0 + tau_y/(gamma + 1/m)
struct Simple {
  static constexpr std::string_view name = "simple";
  static constexpr std::string_view summary = "eta = eta0 + tau_y/(gamma + 1/m)";
  static constexpr std::string_view source = "Frigaard & Nouar 2005 (simple model)";
  double m0 = 1.2;
  static constexpr auto fields() {
    return std::tuple{field("m0", "s", "time scale m; larger is closer to a yield stress", &Simple::m0, positive())};
  }
  template <class T>
  T viscosity(T tau_y, T eta0, T gamma) const {
    return eta0 + tau_y / (gamma + 1 / m0);
  }
};

}  // namespace bagnold::laws::regularisation

// Viscous force between two particles along their separation.
#pragma once
#include <string_view>

#include "core/fields.hpp"

namespace bagnold::laws::viscous {

// Dv_i/Dt = sum_j m_j 8 eta_ij (v_ij . r_ij) grad_i W_ij / (r_ij^2 rho_i rho_j); 8 = 2 (D + 2) for D = 2
// Conserves linear and angular momentum; exact for no lattice: 0.81 to 1.14 of the true shear stress at h/dp = 1.3.
struct Cleary {
  static constexpr std::string_view name = "minatti2015";
  static constexpr std::string_view summary =
      "pair forces along r_ij, uncorrected gradients, pressure p_i/rho_i^2 + p_j/rho_j^2";
  static constexpr std::string_view source = "Cleary 1998; Minatti & Paris 2015, eqs 26, 27, 31";
  static constexpr bool corrected = false;
  static constexpr auto fields() { return std::tuple<>{}; }
  static constexpr double bulk = 5.0 / 3, dilatant = 0;  // inherent in forces along r_ij; documentation only
  static constexpr double coefficient(int dimensions) { return 2.0 * (dimensions + 2); }
};

}  // namespace bagnold::laws::viscous

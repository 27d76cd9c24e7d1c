// Viscous force as the derivative of one discrete dissipation potential.
#pragma once
#include <string_view>

#include "core/fields.hpp"

namespace bagnold::laws::viscous {

// F = -dPhi/dv, Phi = sum_i V_i (eta_i e'_i:e'_i + zeta_i/2 (tr L_i)^2)
//                    + 1/2 sum_i sum_j 1/2 k_ij [e_ij . (v_ij - 1/2 (L_i + L_j) r_ij)]^2, L_i the corrected velocity gradient, e' its symmetric deviator, k_ij = residual 2(D+2) mean(eta) V_i V_j f_ij.
// zeta = bulk eta + dilatant dp/dgamma: with phi(i), pressure falls when oblique compression slows the shear, which is a
// negative bulk viscosity; mu(i) flow is well-posed only if zeta outweighs it. dilatant = 1 does so for every mu >= 1/4 and
// vanishes at rest; a multiple of eta would glue unyielded material together. Pressure is the adjoint of tr L. Exact for linear velocity fields on any particle arrangement (docs/sph.md).
struct Variational {
  static constexpr std::string_view name = "variational";
  static constexpr std::string_view summary =
      "pressure and stress from one energy with corrected gradients: passes the shear patch test";
  static constexpr std::string_view source = "docs/sph.md, after Bonet & Lok 1999";
  static constexpr bool corrected = true;
  double residual = 0.3, bulk = 0, dilatant = 1;
  static constexpr auto fields() {
    return std::tuple{
        field("residual", "", "weight of the term that removes what no gradient sees: numerical friction",
              &Variational::residual, positive()),
        field("bulk", "", "bulk over shear viscosity; without dilatant, below 2 short waves grow in fine particles",
              &Variational::bulk, non_negative()),
        field("dilatant", "", "bulk viscosity over dp/dgamma at constant density, 1 for a well-posed flow",
              &Variational::dilatant, non_negative())};
  }
  double coefficient(int dimensions) const { return residual * 2.0 * (dimensions + 2); }
};

}  // namespace bagnold::laws::viscous

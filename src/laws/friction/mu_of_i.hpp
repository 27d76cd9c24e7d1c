// The mu(I) rheology averaged over the depth of a Bagnold profile.
#pragma once
#include "laws/friction/coulomb.hpp"

namespace bagnold::laws {

// In steady uniform flow I is constant over the depth, I = (5/2) d u/(h sqrt(phi g h cos theta)) = (5/2) F d/(h sqrt(phi)).
struct MuOfI {
  static constexpr std::string_view name = "mu-of-i";
  static constexpr std::string_view summary = "depth-averaged mu(I): mu = mu_s + (mu_2 - mu_s)/(1 + I0/I)";
  static constexpr std::string_view source = "Jop, Forterre & Pouliquen 2006; Gray & Edwards 2014, eq. 2.20";
  double mu_s = 0.38, mu_2 = 0.64, I0 = 0.28, d = 1, phi = 0.6;

  static constexpr auto fields() {
    return std::tuple{field("mu_s", "1", "friction of vanishing shear rate", &MuOfI::mu_s, positive()),
                      field("mu_2", "1", "friction of infinite shear rate", &MuOfI::mu_2, positive()),
                      field("I0", "1", "inertial number half-way between the two", &MuOfI::I0, positive()),
                      field("d", "length", "grain diameter", &MuOfI::d, positive()),
                      field("phi", "1", "solid volume fraction", &MuOfI::phi, open(0, 1))};
  }

  struct Prepared {
    double mu_s, delta_mu, h_scale;  // I0/I = h/(h_scale F)
    template <class N>
    [[gnu::always_inline]] N mu(const N& h, const N& F) const {
      return mu_and_slope(h, F).mu;
    }
    template <class N>
    [[gnu::always_inline]] MuAndSlopeOf<N> mu_and_slope(const N& h, const N& F) const {
      const N y = h_scale * F, q = 1.0 / (y + h + 1e-150);
      return {mu_s + delta_mu * (y * q), delta_mu * h_scale * (h * q) * q};
    }
  };
  Prepared prepared(double /*g*/) const { return {mu_s, mu_2 - mu_s, 2.5 * d / (I0 * std::sqrt(phi))}; }
};

}  // namespace bagnold::laws

// Friction from the flow rule with the exponential stopping height (eqs 38, 39).
#pragma once
#include "core/exponential.hpp"
#include "laws/friction/coulomb.hpp"

namespace bagnold::laws {

// Eq. 38 lacks a minus sign in print: h_stop/(A d) = -ln[(tan theta - tan delta1)/(tan delta2 - tan delta1)].
struct ExponentialFriction {
  static constexpr std::string_view name = "exponential";
  static constexpr std::string_view summary =
      "mu = tan(delta1) + (tan(delta2) - tan(delta1)) exp(-beta h/(A d (F + gamma)))";
  static constexpr std::string_view source = "Weinhart et al. 2012, eq. 39 (Pouliquen 1999)";
  double delta1_deg = 17.5, delta2_deg = 31, A = 4, d = 1, beta = 0.196, gamma = 0.04;

  static constexpr auto fields() {
    using L = ExponentialFriction;
    return std::tuple{field("delta1_deg", "deg", "angle below which no layer flows", &L::delta1_deg, open(0, 90)),
                      field("delta2_deg", "deg", "largest angle of the stopping height", &L::delta2_deg, open(0, 90)),
                      field("A", "d", "length scale of the stopping height, in grain diameters", &L::A, positive()),
                      field("d", "length", "grain diameter", &L::d, positive()),
                      field("beta", "1", "slope of the flow rule", &L::beta, positive()),
                      field("gamma", "1", "offset of the flow rule", &L::gamma)};
  }

  struct Prepared {
    double mu1, delta_mu, a_per_h, gamma;
    template <class N>
    [[gnu::always_inline]] N mu(const N& h, const N& F) const {
      return mu_and_slope(h, F).mu;
    }
    template <class N>
    [[gnu::always_inline]] MuAndSlopeOf<N> mu_and_slope(const N& h, const N& F) const {
      const N inverse = 1.0 / max(F + gamma, N(1e-12)), x = a_per_h * h * inverse,
              part = delta_mu * exp_negative(N(0.0 - x));
      return {mu1 + part, part * x * inverse};
    }
  };
  Prepared prepared(double /*g*/) const {
    const double mu1 = tan_deg(delta1_deg);
    return {mu1, tan_deg(delta2_deg) - mu1, beta / (A * d), gamma};
  }
};

}  // namespace bagnold::laws

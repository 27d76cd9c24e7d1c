// Friction from the flow rule F = beta h/h_stop - gamma with the rational stopping height (eqs 35-37, 47, 50).
#pragma once
#include "laws/friction/coulomb.hpp"

namespace bagnold::laws {

struct PouliquenForterre {
  static constexpr std::string_view name = "pouliquen-forterre";
  static constexpr std::string_view summary =
      "mu = tan(delta1) + (tan(delta2) - tan(delta1))/(1 + beta h/(A d (F + gamma)))";
  static constexpr std::string_view source = "Weinhart et al. 2012, eqs 37 and 50 (Forterre & Pouliquen 2003)";
  double delta1_deg = 17.708, delta2_deg = 32.780, A = 3.355, d = 1, beta = 0.196, gamma = 0.040;

  static constexpr auto fields() {
    using L = PouliquenForterre;
    return std::tuple{field("delta1_deg", "deg", "angle below which no layer flows", &L::delta1_deg, open(0, 90)),
                      field("delta2_deg", "deg", "largest angle of the stopping height", &L::delta2_deg, open(0, 90)),
                      field("A", "d", "length scale of the stopping height, in grain diameters", &L::A, positive()),
                      field("d", "length", "grain diameter", &L::d, positive()),
                      field("beta", "1", "slope of the flow rule", &L::beta, positive()),
                      field("gamma", "1", "offset of the flow rule", &L::gamma)};
  }

  // The pole of eq. 37 at F = -gamma (gamma < 0) is removed: below it the friction is that of delta1.
  struct Prepared {
    double mu1, delta_mu, a_per_h, gamma;  // a = beta h/(A d)
    template <class N>
    [[gnu::always_inline]] N mu(const N& h, const N& F) const {
      const N y = max(F + gamma, N(0.0));
      return mu1 + delta_mu * y / (y + a_per_h * h + 1e-150);
    }
    template <class N>
    [[gnu::always_inline]] MuAndSlopeOf<N> mu_and_slope(const N& h, const N& F) const {
      const N y = max(F + gamma, N(0.0)), a = a_per_h * h, q = 1.0 / (y + a + 1e-150);
      return {mu1 + delta_mu * (y * q), delta_mu * (a * q) * q};
    }
  };
  Prepared prepared(double /*g*/) const {
    const double mu1 = tan_deg(delta1_deg);
    return {mu1, tan_deg(delta2_deg) - mu1, beta / (A * d), gamma};
  }
};

// h_stop(theta), eq. 35 and 45, in the unit of d. Zero at delta2 and above, infinite at delta1 and below.
inline double stopping_height(const PouliquenForterre& p, double theta_deg) {
  if (theta_deg <= p.delta1_deg) return std::numeric_limits<double>::infinity();
  if (theta_deg >= p.delta2_deg) return 0;
  const double t = tan_deg(theta_deg);
  return p.A * p.d * (tan_deg(p.delta2_deg) - t) / (t - tan_deg(p.delta1_deg));
}

}  // namespace bagnold::laws

// Friction from Jenkins' flow rule F = beta (h/h_stop) tan^2(theta)/tan^2(delta1) - gamma (eq. 40).
#pragma once
#include "laws/friction/coulomb.hpp"

namespace bagnold::laws {

struct Jenkins {
  static constexpr std::string_view name = "jenkins";
  static constexpr std::string_view summary =
      "mu solves (F + gamma) A d (tan(delta2) - mu) tan^2(delta1) = beta h (mu - tan(delta1)) mu^2";
  static constexpr std::string_view source = "Weinhart et al. 2012, eq. 40 (Jenkins 2006)";
  double delta1_deg = 17.708, delta2_deg = 32.780, A = 3.355, d = 1, beta = 0.15, gamma = 0.04;

  static constexpr auto fields() {
    using L = Jenkins;
    return std::tuple{field("delta1_deg", "deg", "angle below which no layer flows", &L::delta1_deg, open(0, 90)),
                      field("delta2_deg", "deg", "largest angle of the stopping height", &L::delta2_deg, open(0, 90)),
                      field("A", "d", "length scale of the stopping height, in grain diameters", &L::A, positive()),
                      field("d", "length", "grain diameter", &L::d, positive()),
                      field("beta", "1", "slope of the flow rule", &L::beta, positive()),
                      field("gamma", "1", "offset of the flow rule", &L::gamma)};
  }

  // f(mu) = a (mu - mu1) mu^2 - y mu1^2 (mu2 - mu) is increasing and convex on [mu1, mu2], so Newton's iteration
  // from mu2 falls monotonically on the root; eight steps reach round-off for any a, y.
  struct Prepared {
    double mu1, mu2, a_per_h, gamma;
    static constexpr int newton_steps = 8;
    template <class N>
    struct Balance {
      N a, b;
    };
    template <class N>
    Balance<N> balance(const N& h, const N& F) const {
      return {a_per_h * h + 1e-300, max(F + gamma, N(0.0)) * (mu1 * mu1)};
    }
    template <class N>
    [[gnu::always_inline]] N mu(const N& h, const N& F) const {
      const auto [a, b] = balance(h, F);
      N m = mu2;
      for (int k = 0; k < newton_steps; ++k)
        m = m - (a * (m - mu1) * m * m - b * (mu2 - m)) / (a * m * (3.0 * m - 2 * mu1) + b);
      return m;
    }
    template <class N>
    MuAndSlopeOf<N> mu_and_slope(const N& h, const N& F) const {
      const auto [a, b] = balance(h, F);
      const N m = mu(h, F);
      return {m, mu1 * mu1 * (mu2 - m) / (a * m * (3.0 * m - 2 * mu1) + b)};
    }
  };
  Prepared prepared(double /*g*/) const { return {tan_deg(delta1_deg), tan_deg(delta2_deg), beta / (A * d), gamma}; }
};

}  // namespace bagnold::laws

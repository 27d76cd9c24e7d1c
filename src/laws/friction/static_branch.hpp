// Starting and stopping: friction below the smallest Froude number of steady flow.
#pragma once
#include "laws/friction/coulomb.hpp"

namespace bagnold::laws {

// F >= F*: the dynamic law. 0 < F < F*: a power law between the starting friction at rest and the dynamic law at F*. At
// rest the friction is whatever holds the layer, at most mu_start(h) = tan(delta3) + (tan(delta2) - tan(delta1))/(1 + h/L).
// F* = 0 switches the branch off: the dynamic law down to rest.
struct StaticBranch {
  static constexpr std::string_view name = "static-branch";
  static constexpr std::string_view summary =
      "F < F*: mu = (F/F*)^kappa (mu_dyn(h, F*) - mu_start(h)) + mu_start(h), mu_start = tan(delta3) + (tan(delta2) - "
      "tan(delta1))/(1 + h/L)";
  static constexpr std::string_view source = "Pouliquen & Forterre 2002; Edwards et al. 2019";
  double froude_star = 0, delta1_deg = 17.708, delta2_deg = 32.780, delta3_deg = 18.708, length = 3.355, kappa = 1;

  static constexpr auto fields() {
    using S = StaticBranch;
    return std::tuple{field("froude_star", "1", "smallest Froude number of steady flow; 0: no static branch",
                            &S::froude_star, non_negative()),
                      field("delta1_deg", "deg", "stopping angle of a thick layer", &S::delta1_deg,
                            Range{.lo = 0, .hi = 90, .hi_open = true}),
                      field("delta2_deg", "deg", "stopping angle of a vanishing layer", &S::delta2_deg,
                            Range{.lo = 0, .hi = 90, .hi_open = true}),
                      field("delta3_deg", "deg", "starting angle of a thick layer", &S::delta3_deg,
                            Range{.lo = 0, .hi = 90, .hi_open = true}),
                      field("length", "length", "thickness scale of the starting angle", &S::length, positive()),
                      field("kappa", "1", "power of F/F* below F*; 1: linear", &S::kappa, positive())};
  }
};

// A dynamic law with its static branch.
template <class Dynamic>
struct BasalFriction {
  Dynamic dynamic;
  double froude_star, inverse_froude_star, mu3, delta_mu, length, kappa;
  BasalFriction(const Dynamic& law, const StaticBranch& s)
      : dynamic(law),
        froude_star(s.froude_star),
        inverse_froude_star(s.froude_star > 0 ? 1 / s.froude_star : 0),
        mu3(tan_deg(s.delta3_deg)),
        delta_mu(tan_deg(s.delta2_deg) - tan_deg(s.delta1_deg)),
        length(s.length),
        kappa(s.kappa) {}

  template <class N>
  N mu_start(const N& h) const {
    return froude_star > 0 ? N(mu3 + delta_mu * (length / (length + h))) : dynamic.mu(h, N(0.0));
  }
  template <class N>
  N mu(const N& h, const N& F) const {
    return mu_and_slope(h, F, mu_start(h)).mu;
  }
  // The slope is that of the dynamic law only: on the weakening branch friction is taken as it is, not linearised.
  template <class N>
  [[gnu::always_inline]] MuAndSlopeOf<N> mu_and_slope(const N& h, const N& F,
                                                      const N& start) const {  // start = mu_start(h)
    const MuAndSlopeOf<N> m = dynamic.mu_and_slope(h, max(F, N(froude_star)));
    const auto slow = F < N(froude_star);
    N part = select(slow, F * inverse_froude_star, N(1.0));
    if (kappa != 1) part = power(part, kappa);
    return {part * (m.mu - start) + start, select(slow, N(0.0), m.slope)};
  }
};

}  // namespace bagnold::laws

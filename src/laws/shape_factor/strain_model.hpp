// Shape factor of the three-layer velocity profile over rough bases (eq. 54).
#pragma once
#include "laws/friction/coulomb.hpp"

namespace bagnold::laws {

// The strain is Bagnold's, sqrt(1 - z/h), in the bulk; below b it falls linearly to a third of its value at b; within
// 5 d of the surface it stays what it is at h - 5 d. b = d_lambda d h_stop(theta; 1)/h (z from the base).
struct StrainModelShapeFactor {
  static constexpr std::string_view name = "strain-model";
  static constexpr std::string_view summary =
      "alpha(h, theta) of Bagnold's profile with a base layer b = d_lambda d h_stop(theta)/h and a linear surface "
      "layer 5 d thick";
  static constexpr std::string_view source = "Weinhart et al. 2012, eq. 54 and table 2";
  double base_layer = 6.678, surface_layer = 5, d = 1, delta1_deg = 17.708, delta2_deg = 32.780, A = 3.355;

  static constexpr auto fields() {
    using L = StrainModelShapeFactor;
    return std::tuple{
        field("base_layer", "1", "d_lambda: thickness of the base layer at h = h_stop, in d", &L::base_layer,
              non_negative()),
        field("surface_layer", "d", "thickness of the layer of constant strain at the surface", &L::surface_layer,
              non_negative()),
        field("d", "length", "grain diameter", &L::d, positive()),
        field("delta1_deg", "deg", "delta1 of the stopping height for lambda = 1", &L::delta1_deg, open(0, 90)),
        field("delta2_deg", "deg", "delta2 of the stopping height for lambda = 1", &L::delta2_deg, open(0, 90)),
        field("A", "d", "A of the stopping height for lambda = 1", &L::A, positive())};
  }
  static constexpr bool is_constant = false;

  // alpha at thickness h and friction mu = tan(theta), in closed form: moments of
  //   u = s_b (z/3 + z^2/(3b)), z < b;  u_b + (2/3) ((1-b)^(3/2) - (1-z)^(3/2)), b < z < t;  u_t + s_t (z - t), z > t
  // with z, b, t in units of h and s = sqrt(1 - z).
  double factor(double h, double mu) const {
    const double mu1 = tan_deg(delta1_deg), mu2 = tan_deg(delta2_deg);
    return prepared_factor(h, mu, mu1, mu2);
  }
  template <class N>
  [[gnu::always_inline]] N prepared_factor(const N& h, const N& mu, double mu1, double mu2) const {
    const N above = max(mu - mu1, N(1e-6)), below = max(mu2 - mu, N(0.0)), inverse_h = 1.0 / max(h, N(1e-6 * d));
    const N b = min(base_layer * d * A * d * below * inverse_h * inverse_h / above, N(1.0));
    const N t = max(1.0 - surface_layer * d * inverse_h, b);
    constexpr double third = 1.0 / 3;
    const N q = 1.0 - b, r = 1.0 - t;  // depths below the surface of the two interfaces
    const N s_b = sqrt(q), s_t = sqrt(r);
    const N u_b = 2 * third * s_b * b;
    const N c = u_b + 2 * third * q * s_b;  // mid layer: u = c - (2/3) (1-z)^(3/2)
    const N u_t = c - 2 * third * r * s_t;
    // base: integral of (z/3 + z^2/(3b)) is b^2 (1/6 + 1/9); of its square b^3 (1/27 + 1/18 + 1/45)
    const N base1 = s_b * b * b * (5.0 / 18), base2 = q * b * b * b * (31.0 / 270);
    const N p52 = 0.4 * (q * q * s_b - r * r * s_t), p4 = 0.25 * (q * q * q * q - r * r * r * r);
    const N mid1 = c * (t - b) - 2 * third * p52;
    const N mid2 = c * c * (t - b) - 4 * third * c * p52 + 4 * third * third * p4;
    const N top1 = u_t * r + 0.5 * s_t * r * r, top2 = u_t * u_t * r + u_t * s_t * r * r + third * r * r * r * r;
    const N mean = base1 + mid1 + top1, square = base2 + mid2 + top2;
    // A layer that is all base layer (b = 1) has no Bagnold strain left; its limit is the base profile itself.
    const double plain = (31.0 / 270) / ((5.0 / 18) * (5.0 / 18));
    return select(mean > N(1e-12), square / (mean * mean), N(plain));
  }
};

}  // namespace bagnold::laws

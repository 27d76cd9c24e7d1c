// Hertz contact with viscoelastic damping of constant restitution (Tsuji et al. 1992; Antypov & Elgeti 2011):
//   f^n = K delta^(3/2) - alpha(eps) sqrt(m_ij K) delta^(1/4) v_n,   K = (4/3) E* sqrt(R_ij),
//   alpha = -sqrt(5) ln eps / sqrt(ln^2 eps + pi^2).
#pragma once
#include <cmath>
#include <numbers>
#include <string_view>
#include <tuple>
#include <variant>

#include "core/fields.hpp"
#include "laws/contact/collision.hpp"
#include "laws/contact/response.hpp"

namespace bagnold::laws {

template <class N>
struct HertzNormal {
  static constexpr bool constant_stiffness = false;
  N modulus;  // E*, force/area
  N alpha;    // damping number, -
  // With x = K sqrt(delta): x delta, alpha sqrt(m_ij x), 3/2 x.
  NormalResponse<N> respond(N overlap, const PairSize<N>& size) const {
    const N x = N(4.0 / 3) * modulus * ieee_sqrt(max(N(0), size.reduced_radius * overlap));
    return {x * overlap, alpha * ieee_sqrt(x * size.reduced_mass()), N(1.5) * x};
  }
  // Stiffness at the overlap `before` over that at `now` > 0.
  N stiffness_ratio(N before, N now) const { return ieee_sqrt(before / now); }
  N energy(N overlap, const PairSize<N>& size) const {
    return N(8.0 / 15) * modulus * sqrt(size.reduced_radius * overlap) * overlap * overlap;
  }

  // Collision time of an elastic pair that meets at `speed` (Landau & Lifshitz, Theory of Elasticity, section 9):
  //   tc = (2/v) (5 m v^2/(4 K))^(2/5) integral_0^1 dx/sqrt(1 - x^(5/2)).
  double collision_time(const PairSize<double>& size, double speed) const {
    constexpr double integral = 1.4716378;  // sqrt(pi) Gamma(2/5) / (5/2 Gamma(9/10))
    const double k = 4.0 / 3 * modulus * std::sqrt(size.reduced_radius);
    return 2 / speed * std::pow(1.25 * size.reduced_mass() * speed * speed / k, 0.4) * integral;
  }
  // At the speed that would reach an overlap of 1 % of the reduced radius.
  Collision collision(const PairSize<double>& size) const {
    const double speed = std::sqrt(2 * energy(0.01 * size.reduced_radius, size) / size.reduced_mass());
    return {collision_time(size, speed), std::exp(-alpha * std::numbers::pi / std::sqrt(5 - alpha * alpha))};
  }
};

struct Hertz {
  static constexpr std::string_view name = "hertz";
  static constexpr std::string_view summary = "Hertz contact, viscoelastic damping of constant restitution";
  static constexpr std::string_view source = "Antypov & Elgeti 2011, eqs 14, 15; Tsuji et al. 1992";
  double young_modulus = 0, poisson_ratio = 0.3, restitution = 0.9;
  static constexpr auto fields() {
    return std::tuple{
        required("young_modulus", "force/area", "Young's modulus of the grains", &Hertz::young_modulus, positive()),
        field("poisson_ratio", "-", "Poisson's ratio of the grains", &Hertz::poisson_ratio,
              Range{.lo = -1, .hi = 0.5, .lo_open = true}),
        field("restitution", "-", "normal restitution, at every speed", &Hertz::restitution,
              Range{.lo = 0, .hi = 1, .lo_open = true})};
  }
  // E* = E/(2 (1 - nu^2)) of two like materials.
  using Constants = std::variant<HertzNormal<double>>;
  Constants constants(const NominalPair&) const {
    const double log_eps = std::log(restitution);
    return HertzNormal<double>{
        young_modulus / (2 * (1 - poisson_ratio * poisson_ratio)),
        -std::sqrt(5.0) * log_eps / std::sqrt(log_eps * log_eps + std::numbers::pi * std::numbers::pi)};
  }
};

}  // namespace bagnold::laws

// Rolling resistance as an elastic-plastic spring-dashpot, Ai et al. 2011, model C:
//   M = -kr theta - Cr dtheta/dt, |kr theta| <= mu_r R |f^n|, no dashpot while it slides;
//   kr = 2.25 kn (mu_r R)^2,  Cr = 2 eta sqrt(I_r kr).
// theta is the relative rolling angle (rotation about axes normal to n; no resistance to twisting).
#pragma once
#include <string_view>
#include <tuple>
#include <variant>

#include "core/fields.hpp"
#include "laws/contact/response.hpp"

namespace bagnold::laws {

template <class N>
struct SpringSliderRolling {
  static constexpr bool active = true;
  N mu, eta;
  N stiffness(const NormalResponse<N>& normal, const PairSize<N>& size) const {
    const N arm = mu * size.reduced_radius;
    return N(2.25) * normal.stiffness * arm * arm;
  }
  N damping(N stiffness, const PairSize<N>& size) const {
    return N(2) * eta * sqrt(stiffness * size.rolling_inertia());
  }
  N limit(N normal_force, const PairSize<N>& size) const { return mu * size.reduced_radius * abs(normal_force); }
};

struct SpringSlider {
  static constexpr std::string_view name = "spring_slider";
  static constexpr std::string_view summary = "elastic-plastic spring-dashpot rolling resistance";
  static constexpr std::string_view source = "Ai et al. 2011, model C, eqs 12-17";
  double rolling_friction = 0.1, rolling_damping = 0.3;
  static constexpr auto fields() {
    return std::tuple{field("rolling_friction", "-", "mu_r: largest torque / (R |f^n|)",
                            &SpringSlider::rolling_friction, non_negative()),
                      field("rolling_damping", "-", "eta: rolling damping / critical", &SpringSlider::rolling_damping,
                            non_negative())};
  }
  using Constants = std::variant<SpringSliderRolling<double>>;
  Constants constants(const NominalPair&) const {
    return SpringSliderRolling<double>{rolling_friction, rolling_damping};
  }
};

}  // namespace bagnold::laws

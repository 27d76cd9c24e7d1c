// Linear tangential spring-dashpot with history and a Coulomb slider:
//   f^t = -kt delta_t - gamma_t v^t, cut to mu |f^n|. Weinhart et al. 2012, eqs 4, 7-9 and algorithm 2.
#pragma once
#include <optional>
#include <string_view>
#include <tuple>
#include <variant>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "laws/contact/response.hpp"

namespace bagnold::laws {

template <class N>
struct LinearTangential {
  static constexpr bool constant_stiffness = true;
  N kt, gamma, mu;
  N stiffness(const NormalResponse<N>&) const { return kt; }
  N damping(const NormalResponse<N>&) const { return gamma; }
};

struct LinearHistory {
  static constexpr std::string_view name = "linear_history";
  static constexpr std::string_view summary = "tangential spring-dashpot with history, Coulomb slip";
  static constexpr std::string_view source = "Weinhart et al. 2012, eqs 4, 7-9, algorithm 2";
  std::optional<double> tangential_stiffness, tangential_damping;
  double friction = 0.5;
  static constexpr auto fields() {
    return std::tuple{field("tangential_stiffness", "force/length", "kt; auto: 2/7 kn (linear normal law only)",
                            &LinearHistory::tangential_stiffness, non_negative()),
                      field("tangential_damping", "mass/time", "gamma_t; auto: gamma_n of a pair of mean grains",
                            &LinearHistory::tangential_damping, non_negative()),
                      field("friction", "-", "Coulomb friction mu", &LinearHistory::friction, non_negative())};
  }
  using Constants = std::variant<LinearTangential<double>>;
  Constants constants(const NominalPair& nominal) const {
    if (!nominal.constant_stiffness && !(tangential_stiffness && tangential_damping))
      throw UnphysicalError("contact.tangential_stiffness",
                            "and tangential_damping have no automatic value unless the normal law is linear");
    return LinearTangential<double>{tangential_stiffness.value_or(2 * nominal.stiffness / 7),
                                    tangential_damping.value_or(nominal.damping), friction};
  }
};

}  // namespace bagnold::laws

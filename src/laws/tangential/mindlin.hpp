// Mindlin's tangential stiffness, proportional to the tangent stiffness of the normal law, with a Coulomb slider:
//   kt = 2 (1 - nu)/(2 - nu) d f^n/d delta   (Mindlin 1949, like materials),   gamma_t = ratio * gamma_n.
// While the normal load grows the force of the spring, not its length, is kept: otherwise loading would create
// energy (Elata & Berryman 1996).
#pragma once
#include <string_view>
#include <tuple>
#include <variant>

#include "core/fields.hpp"
#include "laws/contact/response.hpp"

namespace bagnold::laws {

template <class N>
struct MindlinTangential {
  static constexpr bool constant_stiffness = false;
  N stiffness_ratio, damping_ratio, mu;
  N stiffness(const NormalResponse<N>& normal) const { return stiffness_ratio * normal.stiffness; }
  N damping(const NormalResponse<N>& normal) const { return damping_ratio * normal.damping; }
};

struct Mindlin {
  static constexpr std::string_view name = "mindlin";
  static constexpr std::string_view summary = "tangential stiffness proportional to the normal one, Coulomb slip";
  static constexpr std::string_view source = "Mindlin 1949; Elata & Berryman 1996";
  double poisson_ratio = 0.3, tangential_damping_ratio = 1, friction = 0.5;
  static constexpr auto fields() {
    return std::tuple{
        field("poisson_ratio", "-", "Poisson's ratio of the grains", &Mindlin::poisson_ratio,
              Range{.lo = -1, .hi = 0.5, .lo_open = true}),
        field("tangential_damping_ratio", "-", "gamma_t/gamma_n", &Mindlin::tangential_damping_ratio, non_negative()),
        field("friction", "-", "Coulomb friction mu", &Mindlin::friction, non_negative())};
  }
  using Constants = std::variant<MindlinTangential<double>>;
  Constants constants(const NominalPair&) const {
    return MindlinTangential<double>{2 * (1 - poisson_ratio) / (2 - poisson_ratio), tangential_damping_ratio, friction};
  }
};

}  // namespace bagnold::laws

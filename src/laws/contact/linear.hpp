// Linear spring-dashpot: f^n = kn delta - gamma_n v_n. Weinhart et al. 2012, eq. 3.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "laws/contact/collision.hpp"
#include "laws/contact/response.hpp"

namespace bagnold::laws {

template <class N>
struct LinearNormal {
  static constexpr bool constant_stiffness = true;
  N kn, gamma;
  NormalResponse<N> respond(N overlap, const PairSize<N>&) const { return {kn * overlap, gamma, kn}; }
  N energy(N overlap, const PairSize<N>&) const { return N(0.5) * kn * overlap * overlap; }
  Collision collision(const PairSize<double>& size) const { return collision_of({kn, gamma}, size.reduced_mass()); }
};

// The same with gamma given per reduced mass, f^n = kn delta - gamma m_ij v_n (Silbert et al. 2001): then the rate
// of damping, not the coefficient, is common to pairs of different mass.
template <class N>
struct LinearNormalPerMass {
  static constexpr bool constant_stiffness = true;
  N kn, gamma;
  NormalResponse<N> respond(N overlap, const PairSize<N>& size) const {
    return {kn * overlap, gamma * size.reduced_mass(), kn};
  }
  N energy(N overlap, const PairSize<N>&) const { return N(0.5) * kn * overlap * overlap; }
  Collision collision(const PairSize<double>& size) const {
    return collision_of({kn, gamma * size.reduced_mass()}, size.reduced_mass());
  }
};

// As a user writes it: (stiffness, damping), or (collision_time, restitution) at a stated reduced mass.
struct Linear {
  static constexpr std::string_view name = "linear";
  static constexpr std::string_view summary = "linear spring-dashpot, f = kn delta - gamma_n v";
  static constexpr std::string_view source = "Weinhart et al. 2012, eqs 3, 5, 6";
  std::optional<double> stiffness, damping, collision_time, restitution, reduced_mass;
  std::string damping_convention = "force";
  static constexpr auto fields() {
    return std::tuple{
        field("stiffness", "force/length", "kn; or give collision_time and restitution", &Linear::stiffness,
              positive()),
        field("damping", "mass/time (1/time per_reduced_mass)", "gamma_n", &Linear::damping, non_negative()),
        field("collision_time", "time", "tc of a head-on pair", &Linear::collision_time, positive()),
        field("restitution", "-", "eps of a head-on pair", &Linear::restitution,
              Range{.lo = 0, .hi = 1, .lo_open = true}),
        field("reduced_mass", "mass", "m_i m_j/(m_i + m_j) at which (tc, eps) hold; auto: two mean flowing grains",
              &Linear::reduced_mass, positive()),
        field("damping_convention", "-", "force: f = kn delta - gamma v; per_reduced_mass: f = kn delta - gamma m_ij v",
              &Linear::damping_convention)};
  }

  bool per_reduced_mass() const {
    if (damping_convention != "force" && damping_convention != "per_reduced_mass")
      throw UnphysicalError("contact.damping_convention",
                            "'" + damping_convention + "' is not a convention; expected force or per_reduced_mass");
    return damping_convention == "per_reduced_mass";
  }

  using Constants = std::variant<LinearNormal<double>, LinearNormalPerMass<double>>;
  Constants constants(const NominalPair& nominal) const {
    const SpringDashpot s = spring_dashpot(reduced_mass.value_or(nominal.reduced_mass));
    if (per_reduced_mass()) return LinearNormalPerMass<double>{s.stiffness, s.damping};
    return LinearNormal<double>{s.stiffness, s.damping};
  }

  // kn and gamma in the stated convention, of a pair of that mass.
  SpringDashpot spring_dashpot(double mass) const {
    const bool by_constants = stiffness || damping, by_collision = collision_time || restitution;
    if (by_constants == by_collision || (by_constants ? !(stiffness && damping) : !(collision_time && restitution)))
      throw UnphysicalError("contact.stiffness",
                            "expected either both of stiffness and damping or both of collision_time and restitution");
    if (by_constants) return {*stiffness, *damping};
    SpringDashpot s = spring_dashpot_of({*collision_time, *restitution}, mass);
    if (per_reduced_mass()) s.damping /= mass;
    return s;
  }
};

}  // namespace bagnold::laws

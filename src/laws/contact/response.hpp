// What a normal law is told about a pair, and what it answers. Every normal force has the form
//   f^n = elastic(delta) - damping(delta) v_n,   v_n = v_ij . n  (negative while the pair approaches).
#pragma once
#include "core/numeric.hpp"

namespace bagnold::laws {

// Inverses are 0 for a plane (infinite radius) and for a body that never moves (infinite mass).
template <class N>
struct PairSize {
  N reduced_radius;                      // 1/(1/r_i + 1/r_j)
  N inverse_reduced_mass;                // 1/m_i + 1/m_j
  N inverse_radius_i, inverse_radius_j;  // 1/length
  N inverse_mass_i, inverse_mass_j;      // 1/mass
  N reduced_mass() const { return N(1) / inverse_reduced_mass; }
  // 1/(1/I'_i + 1/I'_j), I' = (7/5) m r^2 of a solid sphere about its contact point (Ai et al. 2011, eq. 17).
  N rolling_inertia() const {
    return N(1.4) / (inverse_mass_i * inverse_radius_i * inverse_radius_i +
                     inverse_mass_j * inverse_radius_j * inverse_radius_j);
  }
};

inline PairSize<double> sizes(double inverse_radius_i, double inverse_radius_j, double inverse_mass_i,
                              double inverse_mass_j) {
  return {1 / (inverse_radius_i + inverse_radius_j),
          inverse_mass_i + inverse_mass_j,
          inverse_radius_i,
          inverse_radius_j,
          inverse_mass_i,
          inverse_mass_j};
}

// What automatic parameters refer to: two mean flowing grains.
struct NominalPair {
  double reduced_mass = 0;
  bool constant_stiffness = false;    // kn and gamma_n below have a meaning
  double stiffness = 0, damping = 0;  // kn, gamma_n (as a force) of the normal law at that mass
};

template <class N>
struct NormalResponse {
  N elastic;    // force at rest, >= 0
  N damping;    // force per closing speed
  N stiffness;  // d elastic / d overlap
};

}  // namespace bagnold::laws

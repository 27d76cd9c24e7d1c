// What the sweeps of the printed equations read of a neighbour. Kinematics writes positions, velocities and masses, the
// momentum rate of the same positions the rest.
#pragma once
#include "sph/work.hpp"

namespace bagnold::sph {

template <int D>
struct PairRecord {
  // P = p/rho^2. For the corrected operator `mass` holds the area and nothing follows it.
  static constexpr int x = 0, v = D, mass = 2 * D, inv_rho = mass + 1, P = mass + 2, eta = mass + 3, size = mass + 4;
};

template <int D>
auto& pair_records(Work& w) {
  if constexpr (D == 2)
    return w.slim;
  else
    return w.wide;
}

}  // namespace bagnold::sph

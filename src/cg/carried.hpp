// What one grain carries, and the fabric of its contacts.
#pragma once
#include <numbers>

#include "cg/channels.hpp"
#include "cg/snapshot.hpp"

namespace bagnold::cg {

// Writes channels [0, kCarried) of a grain of mass m, moment of inertia I and diameter d; `nn` is the sum of n_a n_b over its
// contacts (xx xy xz yy yz zz).
inline void carried_by_grain(double* __restrict q, double m, double I, double d, const Vec3& v, const Vec3& omega,
                             const double* nn) {
  const double volume = std::numbers::pi / 6 * d * d * d;
  q[kMass] = m;
  q[kMomentum + 0] = m * v.x;
  q[kMomentum + 1] = m * v.y;
  q[kMomentum + 2] = m * v.z;
  q[kFlux + 0] = m * v.x * v.x;
  q[kFlux + 1] = m * v.x * v.y;
  q[kFlux + 2] = m * v.x * v.z;
  q[kFlux + 3] = m * v.y * v.y;
  q[kFlux + 4] = m * v.y * v.z;
  q[kFlux + 5] = m * v.z * v.z;
  q[kVolume] = volume;
  q[kVolumeSize] = volume * d;
  q[kInertia] = I;
  q[kSpin + 0] = I * omega.x;
  q[kSpin + 1] = I * omega.y;
  q[kSpin + 2] = I * omega.z;
  for (std::size_t k = 0; k < 6; ++k) q[kFabric + k] = volume * nn[k];
  q[kNumber] = 1;
}

inline void carried_by_grain(double* __restrict q, const Snapshot& s, std::size_t i, const double* nn) {
  carried_by_grain(q, s.mass[i], s.inertia[i], s.diameter[i], s.v[i], s.omega[i], nn);
}

inline void add_normal(double* nn, const Vec3& n) {
  nn[0] += n.x * n.x;
  nn[1] += n.x * n.y;
  nn[2] += n.x * n.z;
  nn[3] += n.y * n.y;
  nn[4] += n.y * n.z;
  nn[5] += n.z * n.z;
}

}  // namespace bagnold::cg

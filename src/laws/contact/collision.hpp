// Collision time and restitution of the linear spring-dashpot, and the way back. Weinhart et al. 2012, eqs 5, 6:
//   tc = pi / sqrt(kn/m - (gamma/(2m))^2),   eps = exp(-tc gamma / (2m)),   m = m_i m_j / (m_i + m_j).
#pragma once
#include <cmath>
#include <numbers>

namespace bagnold::laws {

struct SpringDashpot {
  double stiffness = 0;  // kn, force/length
  double damping = 0;    // gamma_n of f = kn delta - gamma_n v, mass/time
};

struct Collision {
  double time = 0;         // tc; infinite when the pair is overdamped
  double restitution = 0;  // eps; 0 when the pair is overdamped
};

inline Collision collision_of(const SpringDashpot& s, double reduced_mass) {
  const double rate = s.damping / (2 * reduced_mass);
  const double omega2 = s.stiffness / reduced_mass - rate * rate;
  if (!(omega2 > 0)) return {INFINITY, 0};
  const double time = std::numbers::pi / std::sqrt(omega2);
  return {time, std::exp(-time * rate)};
}

// Valid for tc > 0 and 0 < eps <= 1.
inline SpringDashpot spring_dashpot_of(const Collision& c, double reduced_mass) {
  const double rate = -std::log(c.restitution) / c.time, omega = std::numbers::pi / c.time;
  return {reduced_mass * (omega * omega + rate * rate), 2 * reduced_mass * rate};
}

}  // namespace bagnold::laws

// Particles with random velocities, pressures and viscosities, their operators prepared.
#pragma once
#include <vector>

#include "helpers.hpp"
#include "sph/forces.hpp"
#include "sph/implicit.hpp"
#include "sph/kinematics.hpp"

namespace bagnold::sph::test {

struct Case {
  Model model;
  State state;
  Work work;
};

// Positions, random velocities, pressures and viscosities; operators prepared.
inline Case prepare(Model model, int count, double angle, double disorder) {
  Case c{model, block(model, count, angle, disorder), {}};
  c.work.resize(c.state.particles.size(), model.dim);
  rebuild(c.work.pairs, c.state.particles, model, 0);
  Particles& p = c.state.particles;
  kinematics(c.work, p, model, model.corrected() ? Kinematics::corrected : Kinematics::pairs, true);
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    const auto id = static_cast<std::uint64_t>(p.id[i]);
    c.work.pressure[i] = 1000 * random_unit(id, 20);
    c.work.viscosity[i] = 1 + 100 * std::pow(random_unit(id, 21), 4);
    c.work.bulk[i] = c.work.viscosity[i] * random_unit(id, 22);
  }
  if (model.corrected())
    corrected_pressure_and_coefficients(c.work, p, model);
  else
    pair_momentum_rate(c.work, p, model, false), pair_coefficients(c.work, p, model);
  return c;
}

inline Field velocities(const Case& c, std::uint32_t draw) {
  Field v = c.state.particles.v;
  for (std::size_t d = 0; d < static_cast<std::size_t>(c.model.dim); ++d)
    for (std::size_t i = 0; i < v[d].size(); ++i)
      v[d][i] =
          random_unit(static_cast<std::uint64_t>(c.state.particles.id[i]), draw + static_cast<std::uint32_t>(d)) - 0.5;
  return v;
}

inline double inner(const Case& c, const Field& a, const Field& b) {
  double sum = 0;
  for (std::size_t d = 0; d < static_cast<std::size_t>(c.model.dim); ++d)
    for (std::size_t i = 0; i < a[d].size(); ++i) sum += a[d][i] * b[d][i];
  return sum;
}

struct Balance {
  double force = 0, torque = 0;  // over the sums of magnitudes
};
inline Balance balance(const Case& c, const Field& force) {
  const Particles& p = c.state.particles;
  Balance b;
  double total = 0, total_torque = 0, net_torque = 0;
  std::array<double, 3> net{};
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    for (std::size_t d = 0; d < static_cast<std::size_t>(c.model.dim); ++d)
      net[d] += force[d][i], total += std::abs(force[d][i]);
    const double torque = p.x[0][i] * force[1][i] - p.x[1][i] * force[0][i];
    net_torque += torque;
    total_torque += std::abs(torque);
  }
  for (const double f : net) b.force += std::abs(f) / total;
  b.torque = std::abs(net_torque) / total_torque;
  return b;
}

}  // namespace bagnold::sph::test

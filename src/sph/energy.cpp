#include "sph/energy.hpp"

#include "core/parallel.hpp"
#include "sph/forces.hpp"
#include "sph/kinematics.hpp"
#include "sph/observe.hpp"

namespace bagnold::sph {
namespace {

template <class F>
double sum(const Particles& p, F&& f) {
  return parallel_sum<double>(p.size(), [&](std::int64_t k) { return f(static_cast<std::size_t>(k)); });
}

// sum over particles and directions of f(direction, particle)
template <class F>
double dot(const Particles& p, const Model& model, F&& f) {
  return sum(p, [&](std::size_t i) {
    double s = 0;
    for (std::size_t d = 0; d < static_cast<std::size_t>(model.dim); ++d) s += f(d, i);
    return s;
  });
}

double law_friction(const Work& w, const Particles& p) {
  return sum(p, [&](std::size_t i) { return w.viscosity[i] * w.volume[i] * w.shear_rate[i] * w.shear_rate[i]; });
}

}  // namespace

double potential_energy(const State& state, const Model& model) {
  const Particles& p = state.particles;
  return -dot(p, model, [&](std::size_t d, std::size_t i) { return p.mass[i] * model.gravity[d] * p.x[d][i]; });
}

double elastic_energy(const State& state, const Model& model) {
  const Particles& p = state.particles;
  const auto& grains = model.grains();
  return sum(p, [&](std::size_t i) {
    const double pressure = grains.pressure(p.root[i]);
    return 0.5 * grains.compressibility * pressure * pressure * p.mass[i] / grains.grain_density;
  });
}

double ledger_residual(const State& state, const Model& model) {
  const Ledger& l = state.ledger;
  return l.start + l.gravity - l.pressure - l.friction - l.bulk - l.residual - l.artificial - l.stepping - l.walls -
         kinetic_energy(state, model);
}

double compression_power(const Work& w, const Particles& p, const Model& model) {
  return sum(p, [&](std::size_t i) {
    return model.grains().pressure(p.root[i]) * p.mass[i] * w.density_rate[i] / (p.rho[i] * p.rho[i]);
  });
}

double compression_work(const std::vector<double>& before, const Particles& p, const Model& model) {
  return sum(p, [&](std::size_t i) {
    return model.grains().pressure(p.root[i]) * p.mass[i] * (1 / before[i] - 1 / p.rho[i]);
  });
}

void enter_forces(State& state, Work& w, const Model& model) {
  const Particles& p = state.particles;
  Ledger& l = state.ledger;
  const double dt = state.dt;
  double friction = 0, bulk = 0;
  if (model.corrected()) {
    corrected_viscous_force(w, p, model, p.v, w.force);
    const LawDissipation law = corrected_dissipation(w, p, model, p.v);
    friction = law.friction, bulk = law.bulk;
  } else {
    pair_viscous_force(w, p, model, p.v, w.force);
    friction = law_friction(w, p);
  }
  const double viscous = -dot(p, model, [&](std::size_t d, std::size_t i) { return p.v[d][i] * w.force[d][i]; });
  const double pressure = -dot(p, model, [&](std::size_t d, std::size_t i) {
    return p.mass[i] * p.v[d][i] * (w.acceleration[d][i] - model.gravity[d]);
  });
  const double gravity =
      dot(p, model, [&](std::size_t d, std::size_t i) { return p.mass[i] * p.v[d][i] * model.gravity[d]; });
  // m v(n+1).dv, less half m dv^2, is what the kinetic energy gains.
  const double gained = dot(p, model, [&](std::size_t d, std::size_t i) {
    return p.mass[i] * (p.v[d][i] - 0.5 * dt * p.rate[d][i]) * p.rate[d][i];
  });
  l.gravity += dt * gravity;
  l.pressure += dt * pressure;
  l.friction += dt * friction;
  l.bulk += dt * bulk;
  l.residual += dt * (viscous - friction - bulk);
  l.stepping += dt * (gravity - pressure - viscous - gained);
  l.kinetic = kinetic_energy(state, model);
  l.height = potential_energy(state, model) - dt * gravity;
}

void enter_displacements(State& state, const Model& model) {
  Ledger& l = state.ledger;
  l.walls += l.kinetic - kinetic_energy(state, model);
  l.displaced += potential_energy(state, model) - l.height;
}

void separate_forces(Work& w, const Particles& p, const Model& model) {
  update_volumes(w, p);
  const Field total = w.acceleration;
  pair_momentum_rate(w, p, model, false);
  w.cg_q = w.acceleration;
  if (model.numerics.artificial_viscosity > 0) {
    Model without = model;
    without.numerics.artificial_viscosity = 0;
    pair_momentum_rate(w, p, without, true);
    w.cg_z = w.acceleration;
  } else {
    w.cg_z = total;
  }
  w.acceleration = total;
}

void enter_printed_step(State& state, const Work& w, const Model& model) {
  const Particles& p = state.particles;
  Ledger& l = state.ledger;
  const double dt = state.dt;
  const Field &pressed = w.cg_q, &sheared = w.cg_z;  // gravity and pressure; and viscosity of the grains
  // With the mean of v(n) and v(n+1), m v.dv is the change of kinetic energy and v dt the way: nothing is left to the step.
  const auto power = [&](auto&& acceleration) {
    return dot(p, model, [&](std::size_t d, std::size_t i) {
      return p.mass[i] * (p.v[d][i] - 0.5 * dt * p.rate[d][i]) * acceleration(d, i);
    });
  };
  const double friction = law_friction(w, p),
               viscous = -power([&](std::size_t d, std::size_t i) { return sheared[d][i] - pressed[d][i]; });
  l.gravity += dt * power([&](std::size_t d, std::size_t) { return model.gravity[d]; });
  l.pressure -= dt * power([&](std::size_t d, std::size_t i) { return pressed[d][i] - model.gravity[d]; });
  l.friction += dt * friction;
  l.residual += dt * (viscous - friction);
  l.artificial -= dt * power([&](std::size_t d, std::size_t i) { return p.rate[d][i] - sheared[d][i]; });
}

}  // namespace bagnold::sph

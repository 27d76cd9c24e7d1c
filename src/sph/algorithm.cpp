#include "sph/algorithm.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "core/error.hpp"
#include "core/last_step.hpp"
#include "core/parallel.hpp"
#include "sph/constitutive.hpp"
#include "sph/energy.hpp"
#include "sph/forces.hpp"
#include "sph/implicit.hpp"
#include "sph/kinematics.hpp"
#include "sph/observe.hpp"
#include "sph/order.hpp"

namespace bagnold::sph {
namespace {

constexpr double advective_cfl = 0.2;  // h per step at most, for the schemes whose step is not bound by viscosity
constexpr double step_growth = 1.1;    // of those schemes, from a first step of `first_step` times the limit
constexpr double first_step = 0.05;
constexpr double fastest = 1e3;           // m/s: nothing granular moves so fast, the run has failed
constexpr int list_steps = 50;            // a neighbour list should last, explicit steps being short
constexpr double closest_to_wall = 0.02;  // over dp

// a += factor b, all directions.
void add(std::vector<double>& a, const std::vector<double>& b, double factor) {
  double* to = a.data();
  const double* from = b.data();
  parallel_for(static_cast<std::int64_t>(a.size()), [=](std::int64_t i) { to[i] += factor * from[i]; });
}
void add(Field& a, const Field& b, double factor, const Model& model) {
  for (std::size_t d = 0; d < static_cast<std::size_t>(model.dim); ++d) add(a[d], b[d], factor);
}

// D rho/Dt over a step, exact for a constant rate of strain: a loose particle may dilute many times over in one step, and a
// density below zero would be a volume below zero, whose viscosity drives the flow.
void advance_density(const Work& w, Particles& p, double dt) {
  parallel_for(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    p.rho[i] *= std::exp(dt * w.density_rate[i] / p.rho[i]);
  });
}

struct Fastest {
  double v2 = 0;
  Fastest& operator+=(const Fastest& other) {
    v2 = std::max(v2, other.v2);
    return *this;
  }
};

double fastest_particle(const State& state, const Model& model) {
  const Particles& p = state.particles;
  const double v2 =
      parallel_sum<Fastest>(p.size(), [&](std::int64_t k) {
        double sum = 0;
        for (std::size_t d = 0; d < static_cast<std::size_t>(model.dim); ++d) {
          const double c = p.v[d][static_cast<std::size_t>(k)];
          sum += c * c;
        }
        return Fastest{sum < fastest * fastest ? sum : std::numeric_limits<double>::infinity()};  // also for NaN
      }).v2;
  if (!std::isfinite(v2))
    throw NumericalError(
        fmt::format("sph: a particle moves faster than {:g} m/s at t = {:g} s, step {}: the step limits (cfl, "
                    "viscous_factor) are too large for this flow",
                    fastest, state.time, state.step));
  return std::sqrt(v2);
}

// Particles driven over the axis or into the floor are put back and lose that velocity.
void keep_off_axis(Particles& p, const Model& model) {
  const double least = closest_to_wall * model.spacing;
  for (std::size_t i = 0; i < p.x[0].size(); ++i)
    if (p.x[0][i] < least) p.x[0][i] = least, p.v[0][i] = std::max(p.v[0][i], 0.0);
}

// The floor takes mu(i) times as much momentum along itself as it takes across (Coulomb). No pressure or viscosity would:
// both vanish between a particle and an image it coincides with. A particle is a layer no gradient resolves, of depth D and mean
// velocity v, so i = 5/2 v d/(D sqrt(p/rho_s)), the inertial number of a Bagnold profile (Jop et al. 2005).
void keep_above_floor(const Work& w, Particles& p, const Model& model, double dt) {
  const double least = closest_to_wall * model.spacing, d = model.material.grain_diameter,
               rho_s = model.grains().grain_density;
  const auto up = static_cast<std::size_t>(model.vertical());
  std::visit(
      [&](const auto& rheology) {
        parallel_for(p.size(), [&](std::int64_t k) {
          const auto i = static_cast<std::size_t>(k);
          if (p.x[up][i] >= least) return;
          const double across = std::max(-p.v[up][i], 0.0);
          p.x[up][i] = least;
          p.v[up][i] += across;
          double along = 0;
          for (std::size_t a = 0; a < up; ++a) along += p.v[a][i] * p.v[a][i];
          along = std::sqrt(along);
          if (!(across > 0 && along > 0)) return;
          const double depth = model.dim == 2 ? std::sqrt(w.area[i]) : std::cbrt(w.volume[i]),
                       pressure = p.rho[i] * depth * across / dt,
                       inertial = 2.5 * along * d / (depth * std::sqrt(pressure / rho_s)),
                       most = model.numerics.base_friction * rheology.mu(inertial) * across,
                       left = std::max(1 - most / along, 0.0);
          for (std::size_t a = 0; a < up; ++a) p.v[a][i] *= left;
        });
      },
      model.material.rheology);
}

// Symplectic Verlet scheme: whole steps with the rates of the middle, where the velocity is a prediction with the last
// rate. (Half Euler steps of v and rho to the middle and on from there, as the summary of the paper can be read, are of
// first order, feed sound and change angular momentum.)
//                                          Minatti & Paris 2015, section 3.5, after Kajtar & Monaghan 2008
void midpoint_step(State& state, Work& w, const Model& model, double travel) {
  Particles& p = state.particles;
  const double dt = state.dt, half = 0.5 * dt;
  const auto dim = static_cast<std::size_t>(model.dim);
  if (outdated(w.pairs, p, model.dim, half)) rebuild(w.pairs, p, model, travel);
  kinematics(w, p, model, Kinematics::density);
  for (std::size_t d = 0; d < dim; ++d) {
    double *x = p.x[d].data(), *v = p.v[d].data();
    const double* rate = p.rate[d].data();
    parallel_for(p.size(), [=](std::int64_t i) {
      x[i] += half * v[i];
      v[i] += half * rate[i];
    });
  }
  add(p.rho, w.density_rate, half);
  std::vector<double>& first_density_rate = w.force[0];  // scratch of the other schemes
  std::swap(first_density_rate, w.density_rate);
  kinematics(w, p, model, Kinematics::pairs);
  state.max_kinematic_viscosity = constitutive(w, p, model);
  pair_momentum_rate(w, p, model, true);
  ++w.applications;
  if (state.keep_ledger) separate_forces(w, p, model);
  for (std::size_t d = 0; d < dim; ++d) {
    double *x = p.x[d].data(), *v = p.v[d].data();
    const double *rate = w.acceleration[d].data(), *last = p.rate[d].data();
    parallel_for(p.size(), [=](std::int64_t i) {
      v[i] += dt * rate[i] - half * last[i];
      x[i] += half * v[i];
    });
  }
  double* rho = p.rho.data();
  const double *rate = w.density_rate.data(), *first = first_density_rate.data();
  parallel_for(p.size(), [=](std::int64_t i) { rho[i] += dt * rate[i] - half * first[i]; });
  std::swap(p.rate, w.acceleration);
  if (state.keep_ledger) enter_printed_step(state, w, model);
}

// Continuity, with what diffuses and what pulls rho back to the positions.
void change_densities(State& state, Work& w, const Model& model) {
  Particles& p = state.particles;
  const double dt = state.dt, flow = state.keep_ledger ? compression_power(w, p, model) : 0;
  if (model.numerics.density_diffusion > 0) diffuse_density(w, p, model);
  if (state.keep_ledger) state.ledger.diffusion += dt * (compression_power(w, p, model) - flow);
  advance_density(w, p, dt);
  if (model.numerics.volume_correction > 0) {
    const std::vector<double> before = state.keep_ledger ? p.rho : std::vector<double>{};
    correct_volumes(w, p, model, dt);
    if (state.keep_ledger) state.ledger.diffusion += compression_work(before, p, model);
  }
}

// rho -> pressure -> viscosity (implicit: or that of the velocity expected) -> pressure force -> viscous force (at v(n+1) or v(n)) -> x
void sequential_step(State& state, Work& w, const Model& model, double travel) {
  Particles& p = state.particles;
  const double dt = state.dt;
  const bool corrected = model.corrected();
  if (outdated(w.pairs, p, model.dim, 0)) rebuild(w.pairs, p, model, travel);
  kinematics(w, p, model, corrected ? Kinematics::corrected : Kinematics::pairs, true);
  change_densities(state, w, model);
  state.max_kinematic_viscosity = constitutive(w, p, model);
  update_volumes(w, p);
  if (corrected && model.stepping == Stepping::implicit) predict_viscosity(w, state, model, dt);
  if (corrected)
    corrected_pressure_and_coefficients(w, p, model);
  else
    pair_momentum_rate(w, p, model, false), pair_coefficients(w, p, model);
  if (model.stepping == Stepping::implicit) {
    solve_viscous(w, state, model, dt);
  } else {
    viscous_force(w, p, model, p.v, w.force);
    parallel_for(p.size(), [&](std::int64_t k) {
      const auto i = static_cast<std::size_t>(k);
      for (std::size_t d = 0; d < static_cast<std::size_t>(model.dim); ++d) {
        p.rate[d][i] = w.acceleration[d][i] + w.force[d][i] / p.mass[i];
        p.v[d][i] += dt * p.rate[d][i];
      }
    });
  }
  if (state.keep_ledger) enter_forces(state, w, model);
  if (model.numerics.shifting > 0) shift_particles(w, p, model, dt);
  add(p.x, p.v, dt, model);
  if (model.axisymmetric) keep_off_axis(p, model);
  if (model.floor) keep_above_floor(w, p, model, dt);
  if (state.keep_ledger) enter_displacements(state, model);
}

}  // namespace

void check(const Model& model) {
  if (model.axisymmetric && !model.corrected())
    throw UnphysicalError("numerics.operator", "axisymmetric flow needs the variational operator");
  if (model.corrected() && model.stepping == Stepping::minatti2015)
    throw UnphysicalError("numerics.stepping", "the variational operator needs implicit or explicit_euler stepping");
  if (model.corrected() && model.numerics.artificial_viscosity > 0)
    throw UnphysicalError("numerics.artificial_viscosity",
                          "belongs to the minatti2015 operator; the variational one needs none");
  if (!model.corrected() && model.numerics.density_diffusion > 0)
    throw UnphysicalError("numerics.density_diffusion", "needs the variational operator");
  if (model.stepping == Stepping::minatti2015 && (model.numerics.shifting > 0 || model.numerics.volume_correction > 0))
    throw UnphysicalError("numerics.shifting",
                          "shifting and volume correction need implicit or explicit_euler stepping");
  if (model.stepping != Stepping::minatti2015 && model.numerics.artificial_viscosity > 0)
    throw UnphysicalError("numerics.artificial_viscosity", "needs minatti2015 stepping");
  for (std::size_t d = 0; d < 3; ++d)
    if (model.period[d] > 0 && model.period[d] < 2.2 * model.h())
      throw UnphysicalError("scenario.length",
                            fmt::format("a periodic length must exceed 2.2 h = {:g} m", 2.2 * model.h()));
  const auto range = [](const auto& law) { return law.phi_min < law.phi_max; };
  if (!std::visit(range, model.material.dilatancy)) throw UnphysicalError("material.phi_min", "must be below phi_max");
  if (!(std::visit([](const auto& r) { return r.limit_friction() > r.static_friction(); }, model.material.rheology)))
    throw UnphysicalError("material.limit_angle_deg", "must exceed static_angle_deg");
  if (const double most = std::visit([](const auto& s) { return s.largest_friction; }, model.material.yield_surface);
      !(model.static_friction() < most))
    throw UnphysicalError("material.yield_surface",
                          fmt::format("needs static friction below {:g}; use drucker_prager", most));
}

double step_limit(const State& state, const Model& model) {
  const double h = model.h(), c = model.sound_speed(), cfl = model.numerics.cfl;
  double limit = cfl * h / c;
  if (model.stepping != Stepping::implicit)
    limit = std::min(limit, cfl * model.numerics.viscous_factor * h * h / state.max_kinematic_viscosity);
  return limit;
}

void initialise(State& state, Work& w, const Model& model) {
  check(model);
  rebuild(w.pairs, state.particles, model, 0);
  refresh(state, w, model);
  state.ledger.start = kinetic_energy(state, model);
  state.max_kinematic_viscosity = constitutive(w, state.particles, model);
}

void restore(State& state, Work& w, const Model& model) {
  relist(w.pairs, state.particles, model);
  w.resize(state.particles.size(), model.dim);
}

void refresh(const State& state, Work& w, const Model& model) {
  const Particles& p = state.particles;
  w.resize(p.size(), model.dim);
  kinematics(w, p, model, model.corrected() ? Kinematics::corrected : Kinematics::pairs, true);
  Particles copy;
  copy.rho = p.rho;
  copy.mass = p.mass;
  copy.root = p.root;
  constitutive(w, copy, model);
}

void step(State& state, Work& w, const Model& model, double end) {
  const double speed = fastest_particle(state, model);
  double dt = step_limit(state, model);
  if (model.stepping != Stepping::minatti2015) {
    if (speed > 0) dt = std::min(dt, advective_cfl * model.h() / speed);
    dt = std::min(dt, state.dt > 0 ? step_growth * state.dt : first_step * dt);
  }
  const double travel = list_steps * speed * dt;
  const StepLength planned = step_towards(end, state.time, dt);
  state.dt = planned.dt;
  const std::int64_t applications = w.applications;
  if (model.stepping == Stepping::minatti2015)
    midpoint_step(state, w, model, travel);
  else
    sequential_step(state, w, model, travel);
  state.force_evaluations += w.applications - applications;
  state.time = planned.last ? end : state.time + planned.dt;
  ++state.step;
}

}  // namespace bagnold::sph

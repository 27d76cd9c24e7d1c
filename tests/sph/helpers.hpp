// Small models and particle arrangements the tests share.
#pragma once
#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "scenario/continuum_column.hpp"
#include "scenario/inclined_plane.hpp"
#include "sph/algorithm.hpp"

namespace bagnold::sph::test {

inline double random_unit(std::uint64_t item, std::uint32_t draw) {
  return random::uniform(1, random::Stream::test, item, draw);
}

// The sand of table 3, row 3, without gravity or floor.
inline Model free_model(int dim, bool corrected) {
  Model m;
  m.dim = dim;
  m.floor = false;
  m.spacing = 1;
  if (corrected) {  // residual at full weight: errors are measured against forces of random velocities, nearly all residual
    m.viscous = laws::viscous::Variational{.residual = 1};
    m.stepping = Stepping::implicit;
  }
  return m;
}

// Improved numerics for a scenario.
inline void improve(Model& m) {
  m.viscous = laws::viscous::Variational{};
  m.stepping = Stepping::implicit;
  m.numerics.cfl = 0.4;
  m.numerics.shifting = 10;
  m.numerics.volume_correction = 1;
  m.numerics.density_diffusion = 0.03;
  m.numerics.base_friction = 1;
  m.numerics.cg_tolerance = 1e-3;
}

inline Model improved(Model m) {
  improve(m);
  return m;
}

// A block of `count`^dim particles of unit spacing turned by `angle`, moved at random by up to `disorder`.
inline State block(const Model& model, int count, double angle, double disorder, double rho = 1600) {
  const int dim = model.dim, n = dim == 2 ? count * count : count * count * count;
  State s;
  s.particles = make_particles(n, dim);
  for (int i = 0; i < n; ++i) {
    std::array<double, 3> x{};
    int rest = i;
    for (std::size_t d = 0; d < static_cast<std::size_t>(dim); ++d, rest /= count)
      x[d] = rest % count - 0.5 * (count - 1) +
             disorder * (2 * random_unit(static_cast<std::uint64_t>(i), static_cast<std::uint32_t>(d)) - 1);
    const auto k = static_cast<std::size_t>(i);
    s.particles.x[0][k] = std::cos(angle) * x[0] - std::sin(angle) * x[1];
    s.particles.x[1][k] = std::sin(angle) * x[0] + std::cos(angle) * x[1];
    if (dim == 3) s.particles.x[2][k] = x[2];
    s.particles.rho[k] = rho;
    s.particles.mass[k] = rho;
  }
  return s;
}

inline Model incline_model() {
  Model m;
  m.material.rheology = laws::rheology::MuI{20.90, 32.76, 0.279};
  m.material.grain_diameter = 5e-3;
  m.material.eos = laws::eos::CompressibleGrains{800, 1.5e-5};
  m.material.regularisation = laws::regularisation::Minatti2015{190, 1};
  return m;
}

struct Simulation {
  Model model;
  State state;
  Work work;
};

inline Simulation start(const scenario::InclinedPlane& plane, Model model) {
  Simulation r{std::move(model), {}, {}};
  set_geometry(plane, r.model);
  r.state.particles = make_particles(plane, r.model);
  initialise(r.state, r.work, r.model);
  return r;
}
inline Simulation start(const scenario::ContinuumColumn& column, scenario::ColumnGeometry geometry, Model model) {
  Simulation r{std::move(model), {}, {}};
  set_geometry(column, geometry, r.model);
  r.state.particles = make_particles(column, geometry, r.model);
  initialise(r.state, r.work, r.model);
  return r;
}
inline void advance(Simulation& r, double until) {
  while (r.state.time < until) step(r.state, r.work, r.model);
}
inline void steps(Simulation& r, int count) {
  for (int k = 0; k < count; ++k) step(r.state, r.work, r.model);
}

inline const scenario::InclinedPlane small_plane{.angle_deg = 25, .height = 0.05, .length = 0.05, .spacing = 5e-3};
inline const scenario::ContinuumColumn small_column{.radius = 0.03, .height = 0.03, .spacing = 3e-3};

}  // namespace bagnold::sph::test

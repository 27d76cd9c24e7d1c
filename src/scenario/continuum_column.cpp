#include "scenario/continuum_column.hpp"

#include <algorithm>
#include <cmath>

#include "core/constants.hpp"
#include "core/random.hpp"

namespace bagnold::scenario {

void set_geometry(const ContinuumColumn& column, ColumnGeometry geometry, sph::Model& model) {
  model.dim = geometry == ColumnGeometry::cylinder ? 3 : 2;
  model.axisymmetric = geometry == ColumnGeometry::axisymmetric;
  model.floor = true;
  model.spacing = column.spacing;
  model.period = {0, 0, 0};
  model.gravity = {0, 0, 0};
  model.gravity[static_cast<std::size_t>(model.vertical())] = -earth_gravity;
}

sph::Particles make_particles(const ContinuumColumn& column, ColumnGeometry geometry, const sph::Model& model,
                              std::uint64_t seed) {
  const auto up = std::max<std::int64_t>(1, std::llround(column.height / column.spacing)),
             out = std::max<std::int64_t>(1, std::llround(column.radius / column.spacing));
  const double dx = column.radius / static_cast<double>(out), dz = column.height / static_cast<double>(up);
  std::vector<std::array<double, 2>> base;  // horizontal positions
  for (std::int64_t a = geometry == ColumnGeometry::axisymmetric ? 0 : -out; a < out; ++a) {
    const double x = (static_cast<double>(a) + 0.5) * dx;
    if (geometry != ColumnGeometry::cylinder)
      base.push_back({x, 0});
    else
      for (std::int64_t b = -out; b < out; ++b)
        if (const double y = (static_cast<double>(b) + 0.5) * dx; x * x + y * y < column.radius * column.radius)
          base.push_back({x, y});
  }
  // Rows of the lattice below the surface, over each place of the base.
  const double slope = std::tan(column.slope_deg * M_PI / 180);
  std::vector<std::int64_t> rows;
  std::int64_t count = 0;
  for (const auto& [x, y] : base) {
    const double lost = std::sqrt(x * x + y * y) * slope / dz;
    rows.push_back(std::max<std::int64_t>(0, up - static_cast<std::int64_t>(std::llround(std::min(lost, 1e9)))));
    count += rows.back();
  }
  auto p = sph::make_particles(count, model.dim);
  const auto vertical = static_cast<std::size_t>(model.vertical());
  const double rho0 = model.phi_max() * model.grains().grain_density, Kt = model.grains().compressibility;
  std::size_t i = 0;
  for (std::size_t place = 0; place < base.size(); ++place)
    for (std::int64_t b = 0; b < rows[place]; ++b, ++i) {
      const auto [x, y] = base[place];
      const double z = (static_cast<double>(b) + 0.5) * dz,
                   pressure = rho0 * earth_gravity * (static_cast<double>(rows[place]) * dz - z);
      p.x[0][i] = x;
      if (model.dim == 3) p.x[1][i] = y;
      p.x[vertical][i] = z;
      p.root[i] = std::sqrt(Kt * pressure);
      p.rho[i] = rho0 * (1 + Kt * pressure);
      const double volume = model.dim == 3 ? dx * dx * dz : dx * dz * (model.axisymmetric ? 2 * M_PI * x : 1);
      p.mass[i] = p.rho[i] * volume;
    }
  const double reach = column.disorder * column.spacing;
  for (std::size_t d = 0; reach > 0 && d < static_cast<std::size_t>(model.dim); ++d)
    for (i = 0; i < p.mass.size(); ++i)
      p.x[d][i] +=
          reach * (2 * random::uniform(seed, random::Stream::perturbation, i, static_cast<std::uint32_t>(d)) - 1);
  return p;
}

double measured_runout(double a, ColumnGeometry geometry) {
  if (geometry == ColumnGeometry::planar) return a < 1.8 ? 1.2 * a : 1.9 * std::cbrt(a * a);
  return a < 1.7 ? 1.24 * a : 1.6 * std::sqrt(a);
}

}  // namespace bagnold::scenario

#include "scenario/shallow.hpp"

#include <cmath>
#include <numbers>

#include "core/error.hpp"

namespace bagnold::scenario {
namespace {

double radians(double deg) { return deg * std::numbers::pi / 180; }

void grid_of(double length, double width, int cells, int across, double x0, double y0, shallow::Grid& g) {
  if (across > 1 && !(width > 0)) throw UnphysicalError("scenario.width", "two dimensions need a positive width");
  g = {.nx = cells, .ny = across, .x0 = x0, .y0 = y0, .dx = length / cells, .dy = across > 1 ? width / across : 1};
}

// Mean over a cell of a function with kinks, by a fixed number of samples a direction.
double cell_mean(const shallow::Grid& g, int i, int j, const std::function<double(double, double)>& f) {
  constexpr int samples = 8;
  const int across = g.two_d() ? samples : 1;
  double sum = 0;
  for (int b = 0; b < across; ++b)
    for (int a = 0; a < samples; ++a)
      sum += f(g.x0 + (i + (a + 0.5) / samples) * g.dx, g.two_d() ? g.y0 + (j + (b + 0.5) / across) * g.dy : 0);
  return sum / (samples * across);
}

}  // namespace

void set_up(const Incline& s, shallow::Definition& d) {
  grid_of(s.length, s.width, s.cells, s.cells_across, s.x0, s.y0, d.grid);
  const double theta = radians(s.angle_deg), turn = radians(s.direction_deg);
  d.gravity = {.normal = s.gravity * std::cos(theta),
               .slope_x = std::tan(theta) * std::cos(turn),
               .slope_y = std::tan(theta) * std::sin(turn),
               .g = s.gravity};
}

void set_up(const RunOut& s, shallow::Definition& d) {
  grid_of(s.length, s.width, s.cells, s.cells_across, 0, -0.5 * s.width, d.grid);
  d.gravity = {.normal = s.gravity, .slope_x = 0, .slope_y = 0, .g = s.gravity};
  d.terrain = true;
  const double steep = std::tan(radians(s.angle_deg)), flat = std::tan(radians(s.runout_angle_deg));
  const double end = s.bend_at + s.bend_length;
  // the slope falls linearly over the bend
  const auto height = [&](double x) {
    const double bend = std::min(std::max(x - s.bend_at, 0.0), s.bend_length);
    return -steep * std::min(x, s.bend_at) - (steep * bend + (flat - steep) * bend * bend / (2 * s.bend_length)) -
           flat * std::max(x - end, 0.0);
  };
  const auto side = [&](double x, double y) {
    if (!(s.channel_depth > 0)) return 0.0;
    const double fade = std::min(std::max((end - x) / s.bend_length, 0.0), 1.0), r = 2 * y / s.width;
    return s.channel_depth * r * r * fade * fade * (3 - 2 * fade);
  };
  d.bed.assign(static_cast<std::size_t>(d.grid.padded()), 0.0);
  const double bottom = height(s.length);
  for (int j = -shallow::halo; j < d.grid.ny + shallow::halo; ++j)
    for (int i = -shallow::halo; i < d.grid.nx + shallow::halo; ++i)
      d.bed[d.grid.at(i, j)] = height(d.grid.x(i)) - bottom + (d.grid.two_d() ? side(d.grid.x(i), d.grid.y(j)) : 0);
}

void fill_slab(const Release& r, const shallow::Solver& solver, shallow::State& state) {
  const shallow::Grid& g = solver.setup.grid;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const double h = cell_mean(g, i, j, [&](double x, double) {
        if (x < r.from || x > r.to) return 0.0;
        return r.thickness * (1 + r.perturbation * std::sin(2 * std::numbers::pi * x / r.wavelength));
      });
      shallow::set_cell(solver, state, i, j, h, h > 0 ? r.velocity : 0);
    }
}

void fill_cap(const Release& r, const shallow::Solver& solver, shallow::State& state) {
  const shallow::Grid& g = solver.setup.grid;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const double h = cell_mean(g, i, j, [&](double x, double y) {
        const double dx = (x - r.centre_x) / r.radius, dy = g.two_d() ? (y - r.centre_y) / r.radius : 0;
        return r.thickness * std::max(0.0, 1 - dx * dx - dy * dy);
      });
      shallow::set_cell(solver, state, i, j, h, h > 0 ? r.velocity : 0);
    }
}

}  // namespace bagnold::scenario

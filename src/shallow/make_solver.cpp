#include <fmt/core.h>

#include <cmath>

#include "core/error.hpp"
#include "shallow/solver.hpp"

namespace bagnold::shallow {
namespace {

void require(bool fine, const char* key, const std::string& what) {
  if (!fine) throw UnphysicalError(key, what);
}

void check(const Definition& s) {
  const Grid& g = s.grid;
  require(g.nx >= 2 && g.ny >= 1 && g.ny != 2, "grid",
          fmt::format("{} x {} cells; need at least 3 in each direction that has more than one", g.nx, g.ny));
  require(g.dx > 0 && g.dy > 0, "grid", "cells must have a positive size");
  require(s.gravity.normal > 0 && s.gravity.g > 0, "gravity", "the component normal to the bed must be positive");
  require(s.scheme.cfl > 0 && s.scheme.cfl <= 0.5, "scheme.cfl", fmt::format("{} is outside (0, 0.5]", s.scheme.cfl));
  require(s.scheme.dry_depth >= 0 && s.scheme.tip_depth >= 0, "scheme", "depths must not be negative");
  require(s.scheme.tile_nx >= 4 && s.scheme.tile_nx <= max_tile && s.scheme.tile_ny >= 4, "scheme.tile",
          "tiles must be 4 to 124 cells wide and at least 4 high");
  require(s.bed.empty() || static_cast<std::int64_t>(s.bed.size()) == g.padded(), "bed",
          "size does not match the grid");
  require(!s.terrain || !s.bed.empty(), "bed", "terrain needs an elevation");
  for (double b : s.bed) require(std::isfinite(b), "bed", "elevation is not a number");
  require(s.width.empty() || (!g.two_d() && static_cast<int>(s.width.size()) == g.nx + 1), "width",
          "a channel width needs a one-dimensional grid and nx + 1 values");
  for (double w : s.width) require(w > 0, "width", "must be positive");
  for (std::size_t pair : {std::size_t{0}, std::size_t{2}})
    require((s.boundary[pair].kind == BoundaryKind::periodic) == (s.boundary[pair + 1].kind == BoundaryKind::periodic),
            "boundary", "periodic sides come in pairs");
  for (const Boundary& b : s.boundary)
    if (b.kind == BoundaryKind::inflow) {
      const Hydrograph& q = b.inflow;
      require(!q.t.empty() && q.h.size() == q.t.size() && q.u.size() == q.t.size(), "boundary.inflow",
              "needs as many thicknesses and velocities as times");
      for (std::size_t k = 0; k < q.t.size(); ++k) {
        require(k == 0 || q.t[k] > q.t[k - 1], "boundary.inflow", "times must increase");
        require(q.h[k] >= 0, "boundary.inflow", "thickness must not be negative");
      }
    }
}

// Central differences of the bed, where its ghosts allow; the outermost ghosts copy their neighbours.
void differentiate_bed(Solver& s) {
  const Grid& g = s.setup.grid;
  const auto size = static_cast<std::size_t>(g.padded());
  for (auto* field : {&s.bed_x, &s.bed_y, &s.bed_xx, &s.bed_xy, &s.bed_yy}) field->assign(size, 0.0);
  s.cosine.assign(size, 1.0);
  s.area.assign(size, 1.0);
  const auto inside = [](int k, int n) { return std::min(std::max(k, 1 - halo), n + halo - 2); };
  for (int j = -halo; j < g.ny + halo; ++j)
    for (int i = -halo; i < g.nx + halo; ++i) {
      const int ic = inside(i, g.nx), jc = inside(j, g.ny);
      const auto b = [&](int di, int dj) { return s.bed[g.at(ic + di, jc + dj)]; };
      const std::size_t c = g.at(i, j);
      s.bed_x[c] = (b(1, 0) - b(-1, 0)) / (2 * g.dx);
      s.bed_xx[c] = (b(1, 0) - 2 * b(0, 0) + b(-1, 0)) / (g.dx * g.dx);
      if (g.two_d()) {
        s.bed_y[c] = (b(0, 1) - b(0, -1)) / (2 * g.dy);
        s.bed_yy[c] = (b(0, 1) - 2 * b(0, 0) + b(0, -1)) / (g.dy * g.dy);
        s.bed_xy[c] = (b(1, 1) - b(-1, 1) - b(1, -1) + b(-1, -1)) / (4 * g.dx * g.dy);
      }
      s.area[c] = std::sqrt(1 + (s.bed_x[c] * s.bed_x[c] + s.bed_y[c] * s.bed_y[c]));
      s.cosine[c] = 1 / s.area[c];
    }
}

void spread_bed_in_y(const Grid& g, std::vector<double>& bed) {  // one dimension: the row is all there is
  for (int j = -halo; j < g.ny + halo; ++j)
    for (int i = -halo; i < g.nx + halo; ++i) bed[g.at(i, j)] = bed[g.at(i, 0)];
}

}  // namespace

Solver make_solver(Definition setup) {
  check(setup);
  Solver s;
  s.setup = std::move(setup);
  const Grid& g = s.setup.grid;
  s.closure = prepare(s.setup);
  s.kernels = choose_kernels(s.setup.closure, s.setup.terrain);
  if (!s.setup.width.empty() && s.setup.bed.empty()) s.setup.bed.assign(static_cast<std::size_t>(g.padded()), 0.0);
  s.geometry = s.setup.terrain ? Geometry::terrain : s.setup.bed.empty() ? Geometry::flat : Geometry::bed;
  if (!s.setup.bed.empty()) {
    s.bed = s.setup.bed;
    fill_bed_ghosts(s, s.bed);
    if (!g.two_d()) spread_bed_in_y(g, s.bed);
  }
  if (s.setup.terrain) differentiate_bed(s);

  const auto columns = static_cast<std::size_t>(g.stride());
  s.width_face.assign(columns + row_size, 1.0);  // entry i + halo is the face after cell i
  s.inverse_width.assign(columns + row_size, 1.0);
  if (!s.setup.width.empty()) {
    const auto& w = s.setup.width;
    for (int f = 0; f < static_cast<int>(columns); ++f)
      s.width_face[static_cast<std::size_t>(f)] =
          w[static_cast<std::size_t>(std::min(std::max(f - (halo - 1), 0), g.nx))];
    for (std::size_t k = 1; k < columns; ++k) s.inverse_width[k] = 2 / (s.width_face[k - 1] + s.width_face[k]);
  }
  s.fall_x.assign(columns + row_size, s.setup.gravity.slope_x * g.dx);
  if (s.setup.boundary[0].kind == BoundaryKind::wall) s.fall_x[halo - 1] = 0;
  if (s.setup.boundary[1].kind == BoundaryKind::wall) s.fall_x[static_cast<std::size_t>(g.nx + halo - 1)] = 0;
  s.fall_y = g.two_d() ? s.setup.gravity.slope_y * g.dy : 0;

  s.tiles_x = (g.nx + s.setup.scheme.tile_nx - 1) / s.setup.scheme.tile_nx;
  s.tiles_y = (g.ny + s.setup.scheme.tile_ny - 1) / s.setup.scheme.tile_ny;
  for (auto& stage_crossing : s.crossing)
    for (std::size_t side = 0; side < 4; ++side)
      stage_crossing[side].assign(static_cast<std::size_t>(side < 2 ? g.ny : g.nx), 0.0);
  return s;
}

void set_dry_depth(Solver& s, double depth) {
  s.setup.scheme.dry_depth = depth;
  s.closure.dry_density_depth = depth * s.closure.rho;
}

State empty_state(const Solver& s) {
  State state;
  const auto size = static_cast<std::size_t>(s.setup.grid.padded());
  for (auto* field : {&state.now.D, &state.now.Mx, &state.now.My}) field->assign(size, 0.0);
  for (std::size_t side = 0; side < 4; ++side) state.crossed[side].assign(s.crossing[0][side].size(), 0.0);
  return state;
}

}  // namespace bagnold::shallow

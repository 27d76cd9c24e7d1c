// Terrain and releases from georeferenced files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/shallow_input.hpp"
#include "core/constants.hpp"

namespace bagnold::app {

using config::Case;
using config::Section;

TerrainKeys read_terrain(const Case& input, const Section& section) {
  return {input.file(section, "elevation"), section.get<double>("gravity", earth_gravity, positive(), "length/time^2")};
}

void read_terrain_release(const Case& input, const Section& s, ReleaseKeys& out) {
  out.direction = s.choose("direction", "normal", {"normal", "vertical"});
  const bool raster = s.has("raster");
  out.file = input.file(s, raster ? "raster" : "polygons");
  if (!raster) out.thickness = s.get_auto("thickness", positive(), "length");
}

void place_terrain(const TerrainKeys& keys, const Section& section, shallow::Definition& d, ShallowInput& out) {
  const io::Raster raster = io::read_raster(keys.elevation);
  if (io::in_degrees(raster.projection))
    section.fail("elevation", "its coordinates are degrees; expected a projected coordinate system (lengths)");
  for (std::size_t k = 0; k < raster.values.size(); ++k)
    if (!std::isfinite(raster.values[k]))
      section.fail("elevation",
                   fmt::format("no data at column {}, row {} from the south; fill the raster or crop it",
                               k % static_cast<std::size_t>(raster.nx), k / static_cast<std::size_t>(raster.nx)));
  d.grid = {.nx = raster.nx, .ny = raster.ny, .x0 = raster.x0, .y0 = raster.y0, .dx = raster.dx, .dy = raster.dy};
  d.gravity = {.normal = keys.gravity, .slope_x = 0, .slope_y = 0, .g = keys.gravity};
  d.terrain = true;
  d.bed.assign(static_cast<std::size_t>(d.grid.padded()), 0.0);
  for (int j = 0; j < raster.ny; ++j)
    for (int i = 0; i < raster.nx; ++i)
      d.bed[d.grid.at(i, j)] =
          raster
              .values[static_cast<std::size_t>(j) * static_cast<std::size_t>(raster.nx) + static_cast<std::size_t>(i)];
  out.projection = raster.projection;
  out.georeferenced = true;
}

void release_on_terrain(const ReleaseKeys& keys, const Section& s, ShallowInput& out) {
  const shallow::Grid& g = out.solver.setup.grid;
  std::vector<double> h(static_cast<std::size_t>(g.nx) * static_cast<std::size_t>(g.ny), 0.0);
  const auto cell = [&](int i, int j) -> double& {
    return h[static_cast<std::size_t>(j) * static_cast<std::size_t>(g.nx) + static_cast<std::size_t>(i)];
  };
  if (s.has("raster")) {
    const io::Raster r = io::read_raster(keys.file);
    if (!io::same_projection(r.projection, out.projection))
      s.fail("raster", "its projection is not that of the terrain");
    if (r.nx != g.nx || r.ny != g.ny || std::abs(r.x0 - g.x0) > 1e-6 * g.dx || std::abs(r.y0 - g.y0) > 1e-6 * g.dy ||
        std::abs(r.dx / g.dx - 1) > 1e-9 || std::abs(r.dy / g.dy - 1) > 1e-9)
      s.fail(
          "raster",
          fmt::format(
              "its grid ({} x {} cells of {} x {} at {}, {}) is not that of the terrain ({} x {} of {} x {} at {}, {})",
              r.nx, r.ny, r.dx, r.dy, r.x0, r.y0, g.nx, g.ny, g.dx, g.dy, g.x0, g.y0));
    for (std::size_t k = 0; k < h.size(); ++k) h[k] = std::isfinite(r.values[k]) ? r.values[k] : 0;
    out.largest_thickness = *std::max_element(h.begin(), h.end());
  } else {
    const io::PolygonLayer layer = io::read_polygons(keys.file);
    if (!io::same_projection(layer.projection, out.projection))
      s.fail("polygons", "their projection is not that of the terrain");
    for (const io::Polygon& p : layer.polygons) {
      const auto t = p.thickness ? p.thickness : keys.thickness;
      if (!t) s.fail("thickness", "a polygon has no attribute \"thickness\"; give one for all here");
      out.largest_thickness = std::max(out.largest_thickness, *t);
      for (const auto& ring : p.rings)
        for (const auto& q : ring)
          if (q[0] < g.x0 || q[0] > g.x0 + g.nx * g.dx || q[1] < g.y0 || q[1] > g.y0 + g.ny * g.dy)
            s.fail("polygons", fmt::format("the point ({}, {}) lies outside the terrain", q[0], q[1]));
      for (int j = 0; j < g.ny; ++j)
        for (int i = 0; i < g.nx; ++i)
          if (io::contains(p, g.x(i), g.y(j))) cell(i, j) = *t;
    }
  }
  double volume = 0;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      double t = cell(i, j);
      if (t < 0) s.fail("raster", "release thickness must not be negative");
      if (keys.direction == "vertical") t *= out.solver.cosine[g.at(i, j)];
      shallow::set_cell(out.solver, out.state, i, j, t);
      volume += t;
    }
  if (!(volume > 0)) s.fail("thickness", "the release covers no cell of the terrain");
}

}  // namespace bagnold::app

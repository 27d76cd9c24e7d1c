#include "app/shallow_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace bagnold::app {
namespace {

using config::Case;
using config::Section;

// Of the largest thickness. A front advances by a cell once that holds dry_depth, with what momentum came in last: a tip
// that spans many cells below it is slowed on fine grids (docs/shallow.md).
constexpr double dry_part = 1e-6, arrival_part = 1e-3;

shallow::Boundary read_boundary(const Section& s, const char* side) {
  const std::string kind = s.choose(side, "outflow", {"wall", "outflow", "periodic", "inflow"});
  shallow::Boundary b;
  if (kind == "wall") b.kind = shallow::BoundaryKind::wall;
  if (kind == "periodic") b.kind = shallow::BoundaryKind::periodic;
  if (kind == "inflow") {
    b.kind = shallow::BoundaryKind::inflow;
    const Section q = s.child(std::string(side) + "_inflow");
    b.inflow.t = q.get<std::vector<double>>("t", std::vector<double>{0}, any_number(), "time");
    b.inflow.h = q.get<std::vector<double>>("h", std::nullopt, non_negative(), "length");
    b.inflow.u = q.get<std::vector<double>>("u", std::nullopt, any_number(), "length/time");
  }
  return b;
}

void read_scheme(const Section& s, shallow::Scheme& scheme, double diameter) {
  scheme.cfl = s.get<double>("cfl", scheme.cfl, Range{.lo = 0, .hi = 0.5, .lo_open = true});
  scheme.tip_depth = s.get<double>("tip_depth", 3 * diameter, non_negative(), "length");
  if (const auto step = s.get_auto("max_step", positive(), "time")) scheme.max_step = *step;
}

// Both default to a fraction of the largest thickness: nothing else in a case says what is thin.
void set_depths(const ShallowKeys& keys, ShallowInput& out) {
  const Section root = keys.input->root(), scheme = root.child("scheme");
  for (const shallow::Boundary& b : out.solver.setup.boundary)
    for (const double h : b.inflow.h) out.largest_thickness = std::max(out.largest_thickness, h);
  const double h = out.largest_thickness;
  if (!(h > 0)) throw UnphysicalError("release.thickness", "nothing is released and nothing flows in");
  const double dry = keys.dry_depth.value_or(dry_part * h);
  if (!(dry < h))
    scheme.fail("dry_depth", fmt::format("expected less than the largest thickness, {:g}: nothing would move", h));
  scheme.resolve("dry_depth", dry);
  shallow::set_dry_depth(out.solver, dry);
  shallow::refresh(out.solver, out.state);
  if (shallow::is_dry(out.solver) && !shallow::more_to_come(out.solver, 0))
    throw UnphysicalError("release.thickness", "no cell holds more than scheme.dry_depth and nothing flows in");
  out.impact_depth = keys.arrival_depth.value_or(std::max(arrival_part * h, 10 * dry));
  root.child("observe").resolve("arrival_depth", out.impact_depth);
}

void read_channel(const Section& s, ShallowKeys& out) {
  out.channel_x = s.get<std::vector<double>>("x", std::nullopt, any_number(), "length");
  out.channel_width = s.get<std::vector<double>>("width", std::nullopt, positive(), "length");
  const auto& x = out.channel_x;
  if (x.size() != out.channel_width.size() || x.size() < 2)
    s.fail("width", "expected as many widths as x, at least two");
  for (std::size_t k = 1; k < x.size(); ++k)
    if (!(x[k] > x[k - 1])) s.fail("x", "must increase");
}

// Width of a channel at the faces of the grid, linear between the points (x, width).
void place_channel(const ShallowKeys& keys, shallow::Definition& d) {
  const auto &x = keys.channel_x, &w = keys.channel_width;
  if (x.empty()) return;
  for (int f = 0; f <= d.grid.nx; ++f) {
    const double at = std::min(std::max(d.grid.x0 + f * d.grid.dx, x.front()), x.back());
    std::size_t k = 1;
    while (k + 1 < x.size() && x[k] < at) ++k;
    d.width.push_back(w[k - 1] + (w[k] - w[k - 1]) * (at - x[k - 1]) / (x[k] - x[k - 1]));
  }
}

void read_observers(const Section& s, ShallowKeys& out) {
  for (const Section& item : s.list("gauges"))
    out.gauges.emplace_back(item, Gauge{.x = item.get<double>("x", std::nullopt, any_number(), "length"),
                                        .y = item.get<double>("y", 0.0, any_number(), "length")});
  for (const Section& item : s.list("sections")) {
    const auto a = item.get<std::vector<double>>("from", std::nullopt, any_number(), "length");
    const auto b = item.get<std::vector<double>>("to", std::nullopt, any_number(), "length");
    if (a.size() != 2 || b.size() != 2) item.fail("from", "a cross-section needs two points [x, y]");
    out.sections.emplace_back(item, CrossSection{a[0], a[1], b[0], b[1]});
  }
  out.arrival_depth = s.get_auto("arrival_depth", positive(), "length");
}

void place_observers(const ShallowKeys& keys, ShallowInput& out) {
  const shallow::Grid& g = out.solver.setup.grid;
  for (const auto& [item, gauge] : keys.gauges) {
    Gauge q = gauge;
    q.i = static_cast<int>(std::floor((q.x - g.x0) / g.dx));
    q.j = g.two_d() ? static_cast<int>(std::floor((q.y - g.y0) / g.dy)) : 0;
    if (q.i < 0 || q.i >= g.nx || q.j < 0 || q.j >= g.ny)
      item.fail("x", fmt::format("the gauge ({}, {}) lies outside the grid", q.x, q.y));
    out.gauges.push_back(q);
  }
  for (const auto& [item, line] : keys.sections) {
    if (!g.two_d()) item.fail("from", "a cross-section needs two points [x, y] and a two-dimensional grid");
    for (const auto& [x, y] : {std::pair{line.x1, line.y1}, std::pair{line.x2, line.y2}})
      if (x < g.x0 || x > g.x0 + g.nx * g.dx || y < g.y0 || y > g.y0 + g.ny * g.dy)
        item.fail("from", "the cross-section leaves the grid");
    out.sections.push_back(line);
  }
}

void read_release(const Case& input, const Section& section, ShallowKeys& out) {
  ReleaseKeys& release = out.release;
  release.shape = section.choose("shape", "none", {"none", "slab", "cap", "raster", "polygons"});
  if (release.shape == "slab" || release.shape == "cap") release.numbers = section.read<scenario::Release>();
  if (release.shape == "raster" || release.shape == "polygons") {
    if (out.scenario != "terrain") section.fail("shape", "a release from a file needs scenario.kind = \"terrain\"");
    read_terrain_release(input, section, release);
  }
}

ShallowKeys read_unlocated(Case& input) {
  const Section root = input.root(), scenario = root.child("scenario");
  (void)root.get<std::int64_t>("seed", 1, at_least(0));
  ShallowKeys out;
  out.input = &input;
  out.scenario = scenario.choose("kind", std::nullopt, {"incline", "run-out", "terrain"});
  out.closure = read_closure(input);
  const double diameter = root.child("closure").get<double>("diameter", 1.0, positive(), "length");
  const Section sides = root.child("boundary");
  constexpr std::array<const char*, 4> names = {"left", "right", "bottom", "top"};
  for (std::size_t k = 0; k < 4; ++k) out.boundary[k] = read_boundary(sides, names[k]);
  if (out.scenario == "incline")
    out.setting = scenario.read<scenario::Incline>();
  else if (out.scenario == "run-out")
    out.setting = scenario.read<scenario::RunOut>();
  else
    out.setting = read_terrain(input, scenario);
  if (root.has("channel")) read_channel(root.child("channel"), out);
  read_scheme(root.child("scheme"), out.scheme, diameter);
  out.dry_depth = root.child("scheme").get_auto("dry_depth", positive(), "length");
  read_release(input, root.child("release"), out);
  read_observers(root.child("observe"), out);
  out.time = root.child("time").read<TimeKeys>();
  return out;
}

ShallowInput build_unlocated(const ShallowKeys& keys) {
  const Section root = keys.input->root();
  ShallowInput out;
  shallow::Definition d;
  d.closure = keys.closure;
  d.boundary = keys.boundary;
  if (const auto* terrain = std::get_if<TerrainKeys>(&keys.setting))
    place_terrain(*terrain, root.child("scenario"), d, out);
  if (const auto* incline = std::get_if<scenario::Incline>(&keys.setting)) scenario::set_up(*incline, d);
  if (const auto* runout = std::get_if<scenario::RunOut>(&keys.setting)) scenario::set_up(*runout, d);
  place_channel(keys, d);
  d.scheme = keys.scheme;
  out.scenario = keys.scenario;
  out.solver = shallow::make_solver(std::move(d));
  out.state = shallow::empty_state(out.solver);

  const ReleaseKeys& release = keys.release;
  if (release.shape == "slab") scenario::fill_slab(release.numbers, out.solver, out.state);
  if (release.shape == "cap") scenario::fill_cap(release.numbers, out.solver, out.state);
  if (release.shape == "slab" || release.shape == "cap")
    out.largest_thickness = release.numbers.thickness * (1 + release.numbers.perturbation);
  if (!release.file.empty()) release_on_terrain(release, root.child("release"), out);
  set_depths(keys, out);
  place_observers(keys, out);
  out.end = keys.time.end;
  out.stop_when_arrested = keys.time.stop_when_arrested;
  return out;
}

// f(), whose errors are given their place.
template <class F>
auto located(Case& input, F&& f) {
  try {
    return f();
  } catch (const UnphysicalError& e) {
    input.fail(e.key, e.text);
  }
}

}  // namespace

ShallowKeys read_shallow(Case& input) {
  return located(input, [&] { return read_unlocated(input); });
}

ShallowInput build_shallow(const ShallowKeys& keys) {
  return located(*keys.input, [&] { return build_unlocated(keys); });
}

}  // namespace bagnold::app

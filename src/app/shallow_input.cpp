#include "app/shallow_input.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "app/time_keys.hpp"
#include "core/error.hpp"
#include "scenario/shallow.hpp"

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
void read_depths(const Section& scheme, const Section& observe, ShallowInput& out) {
  for (const shallow::Boundary& b : out.solver.setup.boundary)
    for (const double h : b.inflow.h) out.largest_thickness = std::max(out.largest_thickness, h);
  const double h = out.largest_thickness;
  if (!(h > 0)) throw UnphysicalError("release.thickness", "nothing is released and nothing flows in");
  const double dry = scheme.get_auto("dry_depth", positive(), "length").value_or(dry_part * h);
  if (!(dry < h))
    scheme.fail("dry_depth", fmt::format("expected less than the largest thickness, {:g}: nothing would move", h));
  scheme.resolve("dry_depth", dry);
  shallow::set_dry_depth(out.solver, dry);
  shallow::refresh(out.solver, out.state);
  if (shallow::is_dry(out.solver) && !shallow::more_to_come(out.solver, 0))
    throw UnphysicalError("release.thickness", "no cell holds more than scheme.dry_depth and nothing flows in");
  out.impact_depth =
      observe.get_auto("arrival_depth", positive(), "length").value_or(std::max(arrival_part * h, 10 * dry));
  observe.resolve("arrival_depth", out.impact_depth);
}

// Width of a channel at the faces of the grid, linear between the points (x, width).
void read_channel(const Section& s, shallow::Definition& d) {
  const auto x = s.get<std::vector<double>>("x", std::nullopt, any_number(), "length");
  const auto w = s.get<std::vector<double>>("width", std::nullopt, positive(), "length");
  if (x.size() != w.size() || x.size() < 2) s.fail("width", "expected as many widths as x, at least two");
  for (std::size_t k = 1; k < x.size(); ++k)
    if (!(x[k] > x[k - 1])) s.fail("x", "must increase");
  for (int f = 0; f <= d.grid.nx; ++f) {
    const double at = std::min(std::max(d.grid.x0 + f * d.grid.dx, x.front()), x.back());
    std::size_t k = 1;
    while (k + 1 < x.size() && x[k] < at) ++k;
    d.width.push_back(w[k - 1] + (w[k] - w[k - 1]) * (at - x[k - 1]) / (x[k] - x[k - 1]));
  }
}

void read_observers(const Section& s, ShallowInput& out) {
  const shallow::Grid& g = out.solver.setup.grid;
  for (const Section& item : s.list("gauges")) {
    Gauge q{.x = item.get<double>("x", std::nullopt, any_number(), "length"),
            .y = item.get<double>("y", 0.0, any_number(), "length")};
    q.i = static_cast<int>(std::floor((q.x - g.x0) / g.dx));
    q.j = g.two_d() ? static_cast<int>(std::floor((q.y - g.y0) / g.dy)) : 0;
    if (q.i < 0 || q.i >= g.nx || q.j < 0 || q.j >= g.ny)
      item.fail("x", fmt::format("the gauge ({}, {}) lies outside the grid", q.x, q.y));
    out.gauges.push_back(q);
  }
  for (const Section& item : s.list("sections")) {
    const auto a = item.get<std::vector<double>>("from", std::nullopt, any_number(), "length");
    const auto b = item.get<std::vector<double>>("to", std::nullopt, any_number(), "length");
    if (a.size() != 2 || b.size() != 2 || !g.two_d())
      item.fail("from", "a cross-section needs two points [x, y] and a two-dimensional grid");
    for (const auto& p : {a, b})
      if (p[0] < g.x0 || p[0] > g.x0 + g.nx * g.dx || p[1] < g.y0 || p[1] > g.y0 + g.ny * g.dy)
        item.fail("from", "the cross-section leaves the grid");
    out.sections.push_back({a[0], a[1], b[0], b[1]});
  }
}

ShallowInput read_unlocated(Case& input) {
  const Section root = input.root(), scenario = root.child("scenario");
  (void)root.get<std::int64_t>("seed", 1, at_least(0));
  ShallowInput out;
  shallow::Definition d;
  out.scenario = scenario.choose("kind", std::nullopt, {"incline", "run-out", "terrain"});
  d.closure = read_closure(input);
  const double diameter = root.child("closure").get<double>("diameter", 1.0, positive(), "length");
  const Section sides = root.child("boundary");
  constexpr std::array<const char*, 4> names = {"left", "right", "bottom", "top"};
  for (std::size_t k = 0; k < 4; ++k) d.boundary[k] = read_boundary(sides, names[k]);
  if (out.scenario == "incline")
    scenario::set_up(scenario.read<scenario::Incline>(), d);
  else if (out.scenario == "run-out")
    scenario::set_up(scenario.read<scenario::RunOut>(), d);
  else
    read_terrain(input, scenario, d, out);
  if (root.has("channel")) read_channel(root.child("channel"), d);
  read_scheme(root.child("scheme"), d.scheme, diameter);

  const std::string projection = out.projection;
  const bool georeferenced = out.georeferenced;
  out.solver = shallow::make_solver(std::move(d));
  out.state = shallow::empty_state(out.solver);
  out.projection = projection;
  out.georeferenced = georeferenced;

  const Section release = root.child("release");
  const std::string shape = release.choose("shape", "none", {"none", "slab", "cap", "raster", "polygons"});
  if (shape == "slab" || shape == "cap") {
    const auto r = release.read<scenario::Release>();
    shape == "slab" ? scenario::fill_slab(r, out.solver, out.state) : scenario::fill_cap(r, out.solver, out.state);
    out.largest_thickness = r.thickness * (1 + r.perturbation);
  }
  if (shape == "raster" || shape == "polygons") {
    if (!out.georeferenced) release.fail("shape", "a release from a file needs scenario.kind = \"terrain\"");
    release_on_terrain(input, release, out);
  }
  read_depths(root.child("scheme"), root.child("observe"), out);
  read_observers(root.child("observe"), out);
  const auto time = root.child("time").read<TimeKeys>();
  out.end = time.end;
  out.stop_when_arrested = time.stop_when_arrested;
  return out;
}

}  // namespace

ShallowInput read_shallow(Case& input) {
  try {
    return read_unlocated(input);
  } catch (const UnphysicalError& e) {
    input.fail(e.key, e.text);
  }
}

}  // namespace bagnold::app

// A case of the shallow-layer model: read into keys, then built into a solver and a state.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/time_keys.hpp"
#include "config/case.hpp"
#include "io/raster.hpp"
#include "scenario/shallow.hpp"
#include "shallow/solver.hpp"

namespace bagnold::app {

struct Gauge {
  double x = 0, y = 0;
  int i = 0, j = 0;  // its cell
};

// A line on the map whose discharge is recorded.
struct CrossSection {
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0;
};

struct ShallowInput {
  std::string scenario;
  shallow::Solver solver;
  shallow::State state;
  double end = 0;
  bool stop_when_arrested = false;
  std::vector<Gauge> gauges;
  std::vector<CrossSection> sections;
  double impact_depth = 0;       // thicker than this counts as arrived
  double largest_thickness = 0;  // of what is released and what flows in
  std::string projection;        // of the terrain; rasters are written when there is terrain
  bool georeferenced = false;
};

struct TerrainKeys {
  std::string elevation;  // file
  double gravity = 0;
};

// What lies on the ground at the start: in numbers, or from a raster or polygons.
struct ReleaseKeys {
  std::string shape;  // "none", "slab", "cap", "raster", "polygons"
  scenario::Release numbers;
  std::string direction, file;
  std::optional<double> thickness;  // of polygons that have none of their own
};

// A case as written. Whoever reads it keeps the case.
struct ShallowKeys {
  config::Case* input = nullptr;
  std::string scenario;
  std::variant<scenario::Incline, scenario::RunOut, TerrainKeys> setting;
  closure::ClosureSet closure;
  std::array<shallow::Boundary, 4> boundary;
  shallow::Scheme scheme;
  std::vector<double> channel_x, channel_width;  // empty: no channel
  ReleaseKeys release;
  std::vector<std::pair<config::Section, Gauge>> gauges;
  std::vector<std::pair<config::Section, CrossSection>> sections;
  std::optional<double> dry_depth, arrival_depth;  // else follow from the largest thickness
  TimeKeys time;
};

// Both throw InputError at the place in the case of whatever is wrong or unphysical; the second opens rasters and
// polygons.
ShallowKeys read_shallow(config::Case& input);
ShallowInput build_shallow(const ShallowKeys& keys);

// ---- parts, in shallow_closure.cpp and shallow_terrain.cpp ----------------------------------------------------------
closure::ClosureSet read_closure(const config::Case& input);
TerrainKeys read_terrain(const config::Case& input, const config::Section& section);
void read_terrain_release(const config::Case& input, const config::Section& section, ReleaseKeys& out);
// Elevation raster -> grid and bed of `d`.
void place_terrain(const TerrainKeys& keys, const config::Section& section, shallow::Definition& d, ShallowInput& out);
// Release thickness from a raster or polygons, vertical or normal to the ground; onto the terrain's cells.
void release_on_terrain(const ReleaseKeys& keys, const config::Section& section, ShallowInput& out);

}  // namespace bagnold::app

// A case of the shallow-layer model, read.
#pragma once
#include <string>
#include <vector>

#include "config/case.hpp"
#include "io/raster.hpp"
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

// Throws InputError at the place in the case of whatever is wrong or unphysical.
ShallowInput read_shallow(config::Case& input);

// ---- parts, in shallow_closure.cpp and shallow_terrain.cpp ----------------------------------------------------------
closure::ClosureSet read_closure(const config::Case& input);
// Elevation raster -> grid and bed of `d`.
void read_terrain(const config::Case& input, const config::Section& section, shallow::Definition& d, ShallowInput& out);
// Release thickness from a raster or polygons, vertical or normal to the ground; onto the terrain's cells.
void release_on_terrain(const config::Case& input, const config::Section& section, ShallowInput& out);

}  // namespace bagnold::app

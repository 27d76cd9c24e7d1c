// What a shallow-layer computation is given: grid, gravity, bed, boundaries, scheme, closures. Plain data.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "closure/closure_set.hpp"

namespace bagnold::shallow {

constexpr int reach = 2;         // cells a stage looks at on every side: MUSCL needs two
constexpr int halo = 2 * reach;  // ghost cells on every side: a step is two stages
constexpr int slack = 8;         // entries after the last cell: kernels read eight at a time

// Cells of dx by dy; the first cell's lower left corner is (x0, y0). ny = 1 is the one-dimensional model. Arrays over
// the grid are padded by the halo, row by row, and by the slack at their end.
struct Grid {
  int nx = 1, ny = 1;
  double x0 = 0, y0 = 0, dx = 1, dy = 1;
  bool two_d() const { return ny > 1; }
  std::int64_t stride() const { return nx + 2 * halo; }
  std::int64_t padded() const { return stride() * (ny + 2 * halo) + slack; }
  std::size_t at(int i, int j) const { return static_cast<std::size_t>((j + halo) * stride() + i + halo); }
  double x(int i) const { return x0 + (i + 0.5) * dx; }
  double y(int j) const { return y0 + (j + 0.5) * dy; }
  double cell_area() const { return dx * (two_d() ? dy : 1); }
};

// Chart of an inclined plane: `normal` = g cos(theta); (slope_x, slope_y) = tan(theta) times the downslope direction;
// the bed is a small elevation normal to the plane. Terrain: `normal` = g, slopes 0, the bed is the elevation of a
// surface z = b(x, y) of any slope, thickness is normal to it and (u, v) are the horizontal components of velocity.
struct Gravity {
  double normal = 1, slope_x = 0, slope_y = 0;
  double g = 1;  // the full acceleration of gravity
};

// Thickness and velocity into the domain against time, linear in between, constant outside.
struct Hydrograph {
  std::vector<double> t, h, u;
};

enum class Side { left, right, bottom, top };
enum class BoundaryKind { wall, outflow, periodic, inflow };
struct Boundary {
  BoundaryKind kind = BoundaryKind::outflow;
  Hydrograph inflow;
};

// dry_depth: thinner layers neither move nor push. tip_depth: alpha goes to 1 smoothly below it (0: nowhere), since a
// frictionless dry front is unbounded for alpha > 1. cfl <= 1/2 keeps the thickness non-negative.
struct Scheme {
  double cfl = 0.45, dry_depth = 1e-6, tip_depth = 0;
  double max_step = 1e300;
  int tile_nx = 120, tile_ny = 64;
  bool second_order = true;
};

struct Definition {
  Grid grid;
  Gravity gravity;
  bool terrain = false;       // metric and curvature of the bed, see Gravity
  std::vector<double> bed;    // padded; empty: flat
  std::vector<double> width;  // 1D channel: width at the nx + 1 faces; empty: 1
  std::array<Boundary, 4> boundary;
  Scheme scheme;
  closure::ClosureSet closure;
};

}  // namespace bagnold::shallow

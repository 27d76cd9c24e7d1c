// The shallow-layer solver: Weinhart et al. 2012, eq. 34, by a second-order finite-volume method.
#pragma once
#include <array>
#include <limits>
#include <vector>

#include "core/parallel.hpp"
#include "shallow/rows.hpp"
#include "shallow/state.hpp"

namespace bagnold::shallow {

constexpr double never = std::numeric_limits<double>::infinity();

// What is learnt from a stage.
struct StageResult {
  double rate = 0;        // largest sum over directions of |speed|/d, 1/time: dt rate <= 1/2 keeps D >= 0
  std::int64_t bad = -1;  // padded index of a column that became negative or not a number, else -1
  std::int64_t wet = 0;   // cells
};
using StepResult = std::array<StageResult, 2>;

// A box of cells.
struct Tile {
  int i0 = 0, j0 = 0, nx = 0, ny = 0;
  bool empty() const { return nx <= 0 || ny <= 0; }
};

// Everything derived from the set-up that a step needs. Built once; nothing here changes the result of a step but the
// set-up itself (the boxes only say where there is something to do).
struct Solver {
  Definition setup;
  PreparedClosure closure;
  LawKernels kernels;
  Geometry geometry = Geometry::flat;
  std::vector<double> bed, bed_x, bed_y, bed_xx, bed_xy, bed_yy, cosine, area;  // padded; area = 1/cosine
  std::vector<double> width_face, inverse_width;  // by column, with halo; 1 unless a channel
  std::vector<double> fall_x;                     // fall of the chart over each x face, 0 at walls
  double fall_y = 0;
  Conserved next;  // result of a step
  int tiles_x = 1, tiles_y = 1;
  std::vector<Tile> boxes;             // of each tile, the cells that are wet or can get wet in one step
  std::vector<int> active;             // tiles whose box is not empty
  std::vector<double> crossing[2][4];  // boundary mass flux of each stage
  std::vector<StepResult> tile_results;
  std::vector<Tile> wet_boxes, grown_boxes;  // of each tile: around its wet cells after the step; scratch
  PerThread scratch;
};

// Throws UnphysicalError for a set-up that means nothing (sizes, gravity, CFL, periodic sides that do not pair, ...).
Solver make_solver(Definition setup);
// Of a solver whose state has not been stepped yet; refresh() it then.
void set_dry_depth(Solver& solver, double depth);
// A state at rest without mass, sized for the solver.
State empty_state(const Solver& solver);
// Sets cell (i, j) to thickness h and velocity (u, v): D = rho(h, u) h.
void set_cell(const Solver& solver, State& state, int i, int j, double h, double u = 0, double v = 0);
// Thickness, velocity and closures of a cell.
struct CellView {
  double h, u, v, rho, K, alpha, mu, froude;
};
CellView view_cell(const Solver& solver, const State& state, int i, int j);
// Cells i ... i + n - 1 of row j, at most max_tile, with the kernels of the solver.
void view_cells(const Solver& solver, const State& state, int i, int j, int n, CellRow& row);
// h, u, v of one row of the grid, with the kernels of the solver.
void view_row(const Solver& solver, const State& state, int j, std::vector<double>& h, std::vector<double>& u,
              std::vector<double>& v);

// Call after the state has been set or restored: finds the wet cells.
void refresh(Solver& solver, State& state);
// One step of SSP-RK2 (Heun) of the size the CFL number allows; the last two before `end` share what is left, so that it
// is met exactly. Throws NumericalError naming cell and time.
void advance_one_step(Solver& solver, State& state, double end = never);
// Steps until time >= until, and to `end` at most; shortens no step for `until`.
void advance(Solver& solver, State& state, double until, double end = never);

double total_mass(const Solver& solver, const State& state);    // compensated sum over all cells, in order
double mass_crossed(const Solver& solver, const State& state);  // that left through the boundaries so far (out > 0)
bool at_rest(const Solver& solver, const State& state);         // every cell exactly at rest
bool is_dry(const Solver& solver);                              // no cell is thicker than dry_depth
bool more_to_come(const Solver& solver, double time);           // some inflow has a thickness at `time` or later

// ---- used by advance_one_step ------------------------------------------------------------------------------------
// Both stages from state.now to next. Ghosts of state.now must be filled.
StepResult both_stages(Solver& solver, const State& state, double dt);
void fill_ghosts(const Solver& solver, Conserved& now, double time);
// The next point of a hydrograph that a step of dt would pass although a piece beside it is not much longer: to be met, so
// that no pulse is missed. Else never.
double next_turn(const Solver& solver, double time, double dt);
// `depth` ghosts beyond one side, along the cells lo ... hi - 1.
void fill_side(const Solver& solver, Side side, double time, int lo, int hi, int depth, const Window& u);
void fill_bed_ghosts(const Solver& solver, std::vector<double>& bed);
// The box around the wet cells within `box`.
Tile wet_box(const Solver& solver, const Conserved& u, const Tile& box);
void find_active_tiles(Solver& solver, const State& state);  // from wet_boxes

}  // namespace bagnold::shallow

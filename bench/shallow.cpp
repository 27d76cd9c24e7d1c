// Cell updates per second and core of the shallow-layer solver: one full second-order time step of one wet cell.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "core/parallel.hpp"
#include "shallow/solver.hpp"

namespace {
using namespace bagnold;
using namespace bagnold::shallow;

Definition field(int nx, int ny, bool measured, bool terrain) {
  Definition s;
  s.grid = {.nx = nx, .ny = ny, .dx = 5, .dy = 5};
  const double theta = 26 * std::numbers::pi / 180;
  s.gravity = {.normal = std::cos(theta), .slope_x = std::tan(theta), .slope_y = 0.1, .g = 1};
  if (measured) {
    s.closure = *closure::builtin("weinhart2012/1", 1, 6 / std::numbers::pi);
  } else {
    s.closure.friction = laws::PouliquenForterre{};
    s.closure.shape_factor = laws::ConstantShapeFactor{1.2};
  }
  s.scheme.tip_depth = 3;
  for (Boundary& b : s.boundary) b.kind = BoundaryKind::periodic;
  if (terrain) {
    s.gravity = {.normal = 1, .g = 1};
    s.terrain = true;
    s.bed.assign(static_cast<std::size_t>(s.grid.padded()), 0.0);
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) s.bed[s.grid.at(i, j)] = 8 * std::sin(0.1 * i) * std::cos(0.15 * j);
    for (Boundary& b : s.boundary) b.kind = BoundaryKind::wall;
  }
  return s;
}

struct Field {
  bool measured = false, terrain = false, one_dimension = false;
  double wet_part = 1;
  int threads = 1;
};

void cell_updates(benchmark::State& bench, const Field& f) {
  set_threads(f.threads);
  const int nx = static_cast<int>(bench.range(0)), ny = f.one_dimension ? 1 : nx;
  Solver solver = make_solver(field(nx, ny, f.measured, f.terrain));
  State state = empty_state(solver);
  for (int j = 0; j < ny * f.wet_part; ++j)
    for (int i = 0; i < nx; ++i) set_cell(solver, state, i, j, 10 + std::sin(0.05 * i) * std::cos(0.07 * j), 1, 0.2);
  refresh(solver, state);
  for (int k = 0; k < 3; ++k) advance_one_step(solver, state);
  const double before = state.cell_updates;
  for (auto _ : bench) advance_one_step(solver, state);
  bench.counters["wet_cell_updates/s"] = benchmark::Counter(state.cell_updates - before, benchmark::Counter::kIsRate);
}
void constant_closures(benchmark::State& s) { cell_updates(s, {}); }
void all_closures(benchmark::State& s) { cell_updates(s, {.measured = true}); }
void constant_closures_one_tenth_wet(benchmark::State& s) { cell_updates(s, {.wet_part = 0.1}); }
void constant_closures_on_terrain(benchmark::State& s) { cell_updates(s, {.terrain = true}); }
void constant_closures_two_threads(benchmark::State& s) { cell_updates(s, {.threads = 2}); }
void one_dimension_constant_closures(benchmark::State& s) { cell_updates(s, {.one_dimension = true}); }
void one_dimension_all_closures(benchmark::State& s) { cell_updates(s, {.measured = true, .one_dimension = true}); }

BENCHMARK(constant_closures)->Arg(240)->Arg(960)->Unit(benchmark::kMillisecond);
BENCHMARK(all_closures)->Arg(240)->Unit(benchmark::kMillisecond);
BENCHMARK(constant_closures_one_tenth_wet)->Arg(960)->Unit(benchmark::kMillisecond);
BENCHMARK(constant_closures_on_terrain)->Arg(240)->Unit(benchmark::kMillisecond);
BENCHMARK(one_dimension_constant_closures)->Arg(960)->Unit(benchmark::kMillisecond);
BENCHMARK(one_dimension_all_closures)->Arg(960)->Unit(benchmark::kMillisecond);
BENCHMARK(constant_closures_two_threads)->Arg(960)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace

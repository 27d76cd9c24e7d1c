// Both Runge-Kutta stages, tile by tile. Stage 1 covers what stage 2 looks at, so that a tile needs nothing of its
// neighbours but the state before the step, and what lies between the stages never leaves the cache.
#include <algorithm>

#include "core/parallel.hpp"
#include "shallow/sweep.hpp"

namespace bagnold::shallow {
namespace {

// Grids smaller than this are computed by one thread: starting the others would cost more.
constexpr std::size_t parallel_threshold = 20000;

// The cells that stage 2 of `tile` looks at: within the domain, but also beyond periodic sides.
Tile grown(const Solver& s, const Tile& tile) {
  const Grid& g = s.setup.grid;
  const auto limits = [&](int begin, int n, int cells, Side side, int& out_begin, int& out_n) {
    const bool wraps = s.setup.boundary[static_cast<std::size_t>(side)].kind == BoundaryKind::periodic;
    out_begin = wraps ? begin - reach : std::max(begin - reach, 0);
    out_n = (wraps ? begin + n + reach : std::min(begin + n + reach, cells)) - out_begin;
  };
  Tile t = tile;
  limits(tile.i0, tile.nx, g.nx, Side::left, t.i0, t.nx);
  if (g.two_d()) limits(tile.j0, tile.ny, g.ny, Side::bottom, t.j0, t.ny);
  return t;
}

// Ghosts that stage 2 of `own` looks at, from what stage 1 made of `covered`. Periodic ones have been computed.
void fill_patch_ghosts(const Solver& s, const Tile& own, const Tile& covered, double time, const Window& u) {
  const Grid& g = s.setup.grid;
  const auto fill = [&](Side side, int beyond, int lo, int hi) {
    if (beyond > 0 && s.setup.boundary[static_cast<std::size_t>(side)].kind != BoundaryKind::periodic)
      fill_side(s, side, time, lo, hi, beyond, u);
  };
  fill(Side::left, reach - own.i0, covered.j0, covered.j0 + covered.ny);
  fill(Side::right, own.i0 + own.nx + reach - g.nx, covered.j0, covered.j0 + covered.ny);
  if (!g.two_d()) return;
  fill(Side::bottom, reach - own.j0, own.i0 - reach, own.i0 + own.nx + reach);
  fill(Side::top, own.j0 + own.ny + reach - g.ny, own.i0 - reach, own.i0 + own.nx + reach);
}

template <Geometry G>
StepResult step_of_tile(Solver& s, const State& state, double dt, const Tile& own, Scratch& w) {
  const Grid& g = s.setup.grid;
  const Tile covered = grown(s, own);
  const auto patch = [&](Conserved& u) {
    const auto size = static_cast<std::size_t>((own.ny + 2 * reach) * row_size + slack);
    for (auto* field : {&u.D, &u.Mx, &u.My})
      if (field->size() < size) field->resize(size);
    return Window{u.D.data(), u.Mx.data(), u.My.data(), own.i0 - 2 * reach, own.j0 - reach, row_size};
  };
  const ConstWindow start = window(g, state.now);
  const Window predicted = patch(w.predicted), kept = patch(w.kept);
  StepResult r;
  r[0] = sweep<G>(s, {1, dt, covered, own, start, start, predicted, kept}, w);
  fill_patch_ghosts(s, own, covered, state.time + dt, predicted);
  r[1] = sweep<G>(s, {2, dt, own, own, start, predicted, window(g, s.next), kept}, w);
  return r;
}

template <Geometry G>
StepResult run_step(Solver& s, const State& state, double dt) {
  for (auto& stage_crossing : s.crossing)
    for (auto& side : stage_crossing) std::fill(side.begin(), side.end(), 0.0);
  const auto tiles = static_cast<std::int64_t>(s.active.size());
  std::vector<StepResult>& results = s.tile_results;
  results.assign(s.active.size(), {});
  s.wet_boxes.assign(s.boxes.size(), {});
  const bool worth_it = state.now.D.size() > parallel_threshold && tiles > 1;
  s.scratch.prepare();
  parallel_for(
      tiles,
      [&](std::int64_t a) {
        const auto tile = static_cast<std::size_t>(s.active[static_cast<std::size_t>(a)]);
        results[static_cast<std::size_t>(a)] = step_of_tile<G>(s, state, dt, s.boxes[tile], s.scratch.mine<Scratch>());
        s.wet_boxes[tile] = wet_box(s, s.next, s.boxes[tile]);
      },
      worth_it);
  StepResult all;
  for (const StepResult& r : results)
    for (std::size_t k = 0; k < r.size(); ++k) {
      all[k].rate = std::max(all[k].rate, r[k].rate);
      all[k].wet += r[k].wet;
      if (r[k].bad >= 0) all[k].bad = r[k].bad;
    }
  return all;
}

}  // namespace

StepResult both_stages(Solver& s, const State& state, double dt) {
  switch (s.geometry) {
    case Geometry::flat:
      return run_step<Geometry::flat>(s, state, dt);
    case Geometry::bed:
      return run_step<Geometry::bed>(s, state, dt);
    default:
      return run_step<Geometry::terrain>(s, state, dt);
  }
}

}  // namespace bagnold::shallow

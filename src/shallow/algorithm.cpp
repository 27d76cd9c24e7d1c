// The time loop: SSP-RK2 (Heun). Fluxes and gravity are explicit, friction is implicit in each stage.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/last_step.hpp"
#include "shallow/solver.hpp"

namespace bagnold::shallow {
namespace {

constexpr double positivity_limit = 0.5;  // dt times rate; above it a cell could lose more than it has
constexpr int most_attempts = 30;

[[noreturn]] void give_up(const Solver& s, const State& state, const StageResult& r, double dt) {
  const Grid& g = s.setup.grid;
  const std::int64_t row = r.bad / g.stride() - halo, column = r.bad % g.stride() - halo;
  throw NumericalError(
      fmt::format("shallow layer: mass or momentum lost its meaning near cell ({}, {}) at t = {:.6g}, "
                  "step {}, dt = {:.3g}, in spite of {} smaller steps",
                  column, row, state.time, state.step, dt, most_attempts));
}

void book_crossings(const Solver& s, State& state, double dt) {
  for (std::size_t side = 0; side < 4; ++side) {
    const double face = s.setup.grid.two_d() ? (side < 2 ? s.setup.grid.dy : s.setup.grid.dx) : 1;
    for (std::size_t k = 0; k < state.crossed[side].size(); ++k)
      state.crossed[side][k] += 0.5 * dt * face * (s.crossing[0][side][k] + s.crossing[1][side][k]);
  }
}

}  // namespace

void advance_one_step(Solver& s, State& state, double end) {
  const Scheme& scheme = s.setup.scheme;
  const auto step_for = [&](double rate) {
    return rate > 0 ? std::min(scheme.cfl / rate, scheme.max_step) : scheme.max_step;
  };
  double dt = state.next_step;
  fill_ghosts(s, state.now, state.time);
  if (!(dt > 0)) dt = step_for(both_stages(s, state, 0)[0].rate);
  const double stop = std::min(end, next_turn(s, state.time, dt));
  const StepLength planned = step_towards(stop, state.time, dt);
  dt = planned.dt;
  StepResult done;
  for (int attempt = 0;; ++attempt) {
    done = both_stages(s, state, dt);
    const auto failed = [&](const StageResult& r) { return r.bad >= 0 || !(dt * r.rate <= positivity_limit); };
    const StageResult* worst = std::find_if(done.begin(), done.end(), failed);
    if (worst == done.end()) break;
    if (attempt == most_attempts) give_up(s, state, *worst, dt);
    dt = worst->bad < 0 && std::isfinite(worst->rate) ? std::min(scheme.cfl / worst->rate, 0.9 * dt) : 0.5 * dt;
  }
  std::swap(state.now, s.next);
  book_crossings(s, state, dt);
  const bool as_planned = dt == planned.dt;
  state.time = planned.last && as_planned ? stop : state.time + dt;
  ++state.step;
  state.cell_updates += static_cast<double>(done[1].wet);
  if (state.smallest_step == 0 || !(planned.shortened && as_planned))
    state.smallest_step = state.smallest_step == 0 ? dt : std::min(state.smallest_step, dt);
  // Without waves in the prediction there may still be some in the result, just thick enough to move: look again.
  state.next_step = done[1].rate > 0 ? step_for(done[1].rate) : 0;
  find_active_tiles(s, state);
}

void advance(Solver& s, State& state, double until, double end) {
  while (state.time < until * (1 - 1e-14)) advance_one_step(s, state, end);
}

}  // namespace bagnold::shallow

// The time loop: SSP-RK2 (Heun). Fluxes and gravity are explicit, friction is implicit in each stage.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
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

void advance_one_step(Solver& s, State& state) {
  const Scheme& scheme = s.setup.scheme;
  double dt = state.next_step;
  fill_ghosts(s, state.now, state.time);
  if (!(dt > 0)) {
    const double rate = stage(s, state, 1, 0).rate;
    dt = rate > 0 ? std::min(scheme.cfl / rate, scheme.max_step) : scheme.max_step;
  }
  StageResult first, second;
  for (int attempt = 0;; ++attempt) {
    first = stage(s, state, 1, dt);
    StageResult* worst = &first;
    if (first.bad < 0 && dt * first.rate <= positivity_limit) {
      fill_ghosts(s, s.predicted, state.time + dt);
      second = stage(s, state, 2, dt);
      if (second.bad < 0 && dt * second.rate <= positivity_limit) break;
      worst = &second;
    }
    if (attempt == most_attempts) give_up(s, state, *worst, dt);
    dt = worst->bad < 0 && std::isfinite(worst->rate) ? std::min(scheme.cfl / worst->rate, 0.9 * dt) : 0.5 * dt;
  }
  std::swap(state.now, s.next);
  book_crossings(s, state, dt);
  state.time += dt;
  ++state.step;
  state.cell_updates += static_cast<double>(second.wet);
  state.smallest_step = state.step == 1 ? dt : std::min(state.smallest_step, dt);
  state.next_step = second.rate > 0 ? std::min(scheme.cfl / second.rate, scheme.max_step) : scheme.max_step;
  find_active_tiles(s, state);
}

void advance(Solver& s, State& state, double until) {
  while (state.time < until * (1 - 1e-14)) advance_one_step(s, state);
}

}  // namespace bagnold::shallow

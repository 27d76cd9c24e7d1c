#include "dem/fast/ledger.hpp"

#include <algorithm>
#include <array>

#include "dem/energy.hpp"
#include "dem/fast/engine.hpp"

namespace bagnold::dem::fast {

void open_ledger(Engine& engine) {
  if (!engine.keep_ledger) return;
  const std::size_t numbers = engine.grain.size() * force_doubles;
  engine.ledger.normal.assign(numbers, 0.0);
  engine.ledger.tangential.assign(numbers, 0.0);
  engine.ledger.rolling.assign(engine.history_numbers > 3 ? numbers : 0, 0.0);
  engine.ledger.losses.assign(steps_per_pass * engine.slabs.size(), {});
}

namespace {

using Four = std::array<double, 4>;

double xyz(const Four& sum) { return sum[0] + sum[1] + sum[2]; }

struct Sums {
  Four normal{}, push{}, turn{}, slid{};
};

// The rows [begin, end) of grains that flow. Numbers that stand beside vectors in rows meet zeros.
Sums take_flowing(const double* __restrict velocity, const double* __restrict force, double* __restrict normal,
                  double* __restrict tangential, std::size_t begin, std::size_t end, const Four& gravity, double half) {
  Sums sums;
  for (std::size_t k = 8 * begin; k < 8 * end; k += 8) {
    const double *v = velocity + k, *f = force + k;
    double *n = normal + k, *t = tangential + k;
    for (std::size_t c = 0; c < 4; ++c) {
      const double full = v[c] + half * (f[c] * f[3] + gravity[c]), turn = v[4 + c] + half * (f[4 + c] * f[7]);
      sums.normal[c] += n[c] * full;
      sums.push[c] += t[c] * full;
      sums.turn[c] += n[4 + c] * turn;
      sums.slid[c] += t[4 + c];
    }
    std::fill_n(n, 8, 0.0);
    std::fill_n(t, 8, 0.0);
  }
  return sums;
}

double take_rolling(const double* __restrict velocity, const double* __restrict force, double* __restrict rolling,
                    std::size_t begin, std::size_t end, double half) {
  Four sum{};
  for (std::size_t k = 8 * begin; k < 8 * end; k += 8) {
    const double *v = velocity + k + 4, *f = force + k + 4;
    for (std::size_t c = 0; c < 4; ++c) sum[c] += rolling[k + c] * (v[c] + half * (f[c] * f[3]));
    std::fill_n(rolling + k, 8, 0.0);
  }
  return xyz(sum);
}

}  // namespace

void take_losses(Engine& engine, const Slab& slab, double half_step, Losses& out) {
  static_assert(velocity_doubles == 8 && force_doubles == 8);
  LedgerRows& rows = engine.ledger;
  const double *velocity = engine.rows.velocity.data(), *force = engine.rows.force.data();
  Sums sums = take_flowing(velocity, force, rows.normal.data(), rows.tangential.data(), slab.begin, slab.moving_end,
                           {engine.gravity.x, engine.gravity.y, engine.gravity.z, 0}, half_step);
  const std::size_t last = slab.end + engine.rows_beside();  // fixed grains and walls: their half of what slid
  for (std::size_t k = 8 * slab.moving_end; k < 8 * last; k += 8)
    for (std::size_t c = 0; c < 4; ++c) sums.slid[c] += rows.tangential[k + 4 + c];
  std::fill(rows.normal.begin() + 8 * slab.moving_end, rows.normal.begin() + 8 * last, 0.0);
  std::fill(rows.tangential.begin() + 8 * slab.moving_end, rows.tangential.begin() + 8 * last, 0.0);
  out.power = {-xyz(sums.normal), -xyz(sums.push) - xyz(sums.turn), 0};
  out.sliding = sums.slid[0];
  out.roll_sliding = sums.slid[1];
  if (rows.rolling.empty()) return;
  out.power.rolling = -take_rolling(velocity, force, rows.rolling.data(), slab.begin, slab.moving_end, half_step);
  std::fill(rows.rolling.begin() + 8 * slab.moving_end, rows.rolling.begin() + 8 * last, 0.0);
}

void enter_losses(const Engine& engine, std::int64_t step, int count, DemState& state) {
  Ledger& l = state.ledger;
  const std::size_t slabs = engine.slabs.size();
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k, ++step) {
    Dissipation power;
    for (std::size_t s = k * slabs; s < (k + 1) * slabs; ++s) {
      const Losses& lost = engine.ledger.losses[s];
      power.normal += lost.power.normal;
      power.tangential += lost.power.tangential;
      power.rolling += lost.power.rolling;
      l.sliding += lost.sliding;
      l.roll_sliding += lost.roll_sliding;
      l.opened += lost.opened;
    }
    integrate(l, power, step > 0 ? state.dt : 0);
  }
}

}  // namespace bagnold::dem::fast

#include "dem/fast/engine.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "dem/fast/pass.hpp"
#include "dem/forces.hpp"
#include "dem/neighbours.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

// Nothing overlaps: otherwise every grain would wait for the stores of the last.
double move_rows(double* __restrict position, double* __restrict velocity, double* __restrict force, std::size_t begin,
                 std::size_t end, const Vec3& gravity, double kick, double dt) {
  using simd::Four, simd::load_four, simd::store, simd::three_and_one;
  const Four g = simd::four(gravity.x, gravity.y, gravity.z, 0), kicks = simd::four(kick, kick, kick, 0),
             drift = simd::four(dt, dt, dt, 0), zero = simd::four(0.0);
  Four largest = zero;
  for (std::size_t k = begin; k < end; ++k) {
    double *x = position + position_doubles * k, *v = velocity + velocity_doubles * k, *f = force + force_doubles * k;
    const Four push = load_four(f), turn = load_four(f + 4);
    const Four acceleration = push * simd::spread<3>(push) + g, spin_up = turn * simd::spread<3>(turn);
    const Four moved = acceleration * kicks + load_four(v);
    store(x, moved * drift + load_four(x));
    store(v, moved);
    store(v + 4, spin_up * kicks + load_four(v + 4));
    store(f, three_and_one(zero, push));  // the constants stay
    store(f + 4, three_and_one(zero, turn));
    largest = simd::most(simd::magnitude(acceleration), largest);
  }
  const double x = simd::lane(largest, 0), y = simd::lane(largest, 1), z = simd::lane(largest, 2);
  return std::sqrt(x * x + y * y + z * z);
}

namespace {

// Copies the histories of `count` pairs, `numbers` each in groups of eight pairs: pair k from where place[key[k]] says, or
// from the zeros.
template <std::size_t numbers>
void copy_histories(const std::uint32_t* __restrict key, std::size_t count, const std::uint32_t* __restrict place,
                    std::uint32_t zeros, const double* __restrict from, double* __restrict to) {
  for (std::size_t k = 0; k < count; ++k) {
    const double* source = from + std::min(place[key[k]], zeros);
    double* target = to + k / 8 * 8 * numbers + k % 8;
    for (std::size_t c = 0; c < numbers; ++c) target[8 * c] = source[8 * c];
  }
}

// History of the new inner list from the old one: `place` maps outer pairs to where their numbers were.
void carry_history(Engine& engine, Section& section, Scratch& scratch) {
  const std::size_t numbers = engine.history_numbers;
  constexpr std::uint32_t nowhere = 0xffffffff;
  Selection& next = scratch.inner;
  const std::size_t old_count = section.inner.count, old_padded = (old_count + batch - 1) / batch * batch;
  const std::size_t new_padded = (next.count + batch - 1) / batch * batch;
  const auto zeros = static_cast<std::uint32_t>(old_padded * numbers);
  if (scratch.history.size() < (new_padded + 8) * numbers)
    scratch.history.resize((new_padded + new_padded / 4 + 24) * numbers);
  std::fill_n(section.history.begin() + zeros, 8 * numbers, 0.0);

  if (scratch.place.size() < section.outer_count + 1)
    scratch.place.assign(section.outer_count + section.outer_count / 4 + 16, nowhere);
  std::uint32_t* place = scratch.place.data();
  const std::uint32_t* old_key = section.inner.key.data();
  for (std::size_t k = 0; k < old_count; ++k)
    place[old_key[k]] = static_cast<std::uint32_t>(k / 8 * 8 * numbers + k % 8);
  (numbers == 3 ? copy_histories<3> : copy_histories<6>)(next.key.data(), new_padded, place, zeros,
                                                         section.history.data(), scratch.history.data());
  for (std::size_t k = 0; k < old_count; ++k) place[old_key[k]] = nowhere;
}

// An economical margin: what `steps` steps of the present accelerations would use up, and a quarter more.
double margin_for(const Engine& engine, std::size_t a, int steps) {
  const Slab &left = engine.slabs[a],
             &right = engine.slabs[static_cast<std::size_t>(engine.ring.wrap(static_cast<int>(a) + 1))];
  const double used = Drift{}.after(steps, engine.dt, left.acceleration + right.acceleration);
  return std::max(1.25 * used, 1e-9 * engine.skin);
}

}  // namespace

void refresh(Engine& engine, std::size_t a, Scratch& scratch) {
  Section& section = engine.sections[a];
  const double before = engine.keep_ledger ? engine.dt : 0;
  const auto pads = engine.slabs[a].end;
  const Offset pad_i = offset_of(pads), pad_j = offset_of(pads + 1);
  if (!section.mid_valid.holds()) {
    const double margin = margin_for(engine, a, mid_steps);
    const PairSpan outer{section.outer_i.data(), section.outer_j.data(), nullptr, section.outer_count};
    select(engine.rows, engine.images, outer, mid_steps * engine.dt, before, margin, section.mid);
    section.mid.pad(8, pad_i, pad_j, 0);
    section.mid_valid.renew(mid_steps, margin);
  }
  const double margin = margin_for(engine, a, inner_steps);
  select(engine.rows, engine.images, section.mid.span(), inner_steps * engine.dt, before, margin, scratch.inner);
  scratch.inner.pad(batch, pad_i, pad_j, static_cast<std::uint32_t>(section.outer_count));
  section.inner_valid.renew(inner_steps, margin);
  carry_history(engine, section, scratch);
  std::swap(section.inner, scratch.inner);
  std::swap(section.history, scratch.history);
  if (engine.one_kind) return;
  section.kind.resize(section.inner.i.size());
  for (std::size_t k = 0; k < (section.inner.count + batch - 1) / batch * batch; ++k)
    section.kind[k] = kind_of(engine, row_of(section.inner.i[k]), row_of(section.inner.j[k]));
}

void forces_without_ledger(Engine& engine) {
  with_kernel(engine, [&]<class K>(const auto& tables) { all_forces<K, false>(engine, tables); });
}

void pass_without_ledger(Engine& engine, int from, int to, const Watch* watch) {
  with_kernel(engine, [&]<class K>(const auto& tables) { pass<K, false>(engine, tables, from, to, watch); });
}

namespace {

// Whether the outer list is sure to hold for the next epoch.
bool holds(const Engine& engine, const Slab& slab) {
  return slab.steps_left >= engine.ring.levels &&
         slab.excursion + slab.drift.after(engine.ring.levels, engine.dt, 2 * slab.acceleration) <= 0.499 * engine.skin;
}

double excursion(const Engine& engine, const Slab& slab, double horizon) {
  const Vec3 path = static_cast<double>(engine.step - engine.built_at) * engine.dt * engine.frame;
  const double moving =
      largest_excursion(engine.rows, engine.start, slab.begin, slab.moving_end, path, engine.frame, horizon);
  return slab.moving_end == slab.end ? moving : std::max(moving, norm(path + horizon * engine.frame));  // fixed grains
}

}  // namespace

bool audit(Engine& engine) {
  if (std::all_of(engine.slabs.begin(), engine.slabs.end(), [&](const Slab& slab) { return holds(engine, slab); }))
    return true;  // the usual case is not worth waking threads
  const auto renewed_holds = [&](std::int64_t s) {
    Slab& slab = engine.slabs[static_cast<std::size_t>(s)];
    for (const int steps : {mid_steps, engine.ring.levels}) {
      if (holds(engine, slab)) break;
      slab.excursion = excursion(engine, slab, steps * engine.dt);
      slab.drift = {};
      slab.steps_left = steps;
    }
    return holds(engine, slab);
  };
  return parallel_all(static_cast<std::int64_t>(engine.slabs.size()), renewed_holds, engine.grain.size() >= 500);
}

namespace {

// What a pass may have met that a result must not be built on.
void check(Engine& engine, DemState& state) {
  for (const Slab& slab : engine.slabs)
    if (!(slab.excursion + slab.drift.distance <= 0.5 * engine.skin)) {
      leave(engine, state);
      check_motion(state);
      throw NumericalError(
          fmt::format("step {} (t = {:g}): a grain was thrown {:g} out of its path within {} steps; the step is too "
                      "long for these forces",
                      state.step, state.time(), slab.drift.distance, engine.ring.levels));
    }
  double excess = 0;
  for (const Scratch& scratch : engine.scratch) excess = std::max(excess, scratch.excess);
  if (excess > 0) {
    leave(engine, state);
    report_overlap(state);
  }
}

void take_steps(Engine& engine, DemState& state, std::int64_t steps, const Watch& watch) {
  engine.scratch.resize(std::max(engine.scratch.size(), static_cast<std::size_t>(threads())));
  const Alone alone(engine.ring.blocks() == 1);
  for (const std::int64_t end = engine.step + steps; engine.step < end;) {
    int level = static_cast<int>(engine.step % engine.ring.levels);
    if (level == 0 && !audit(engine)) {
      rebuild(engine, state);
      level = static_cast<int>(engine.step % engine.ring.levels);
    }
    const std::int64_t stop = watch.next_stop(engine.step, end);
    const auto count = static_cast<int>(std::min<std::int64_t>(engine.ring.levels - level, stop - engine.step));
    const bool looked_at = watch.sees(engine.step + count);
    if (looked_at && watch.fast_before) watch.fast_before(engine);
    (engine.keep_ledger ? pass_with_ledger : pass_without_ledger)(engine, level, level + count,
                                                                  looked_at ? &watch : nullptr);
    if (engine.keep_ledger) enter_losses(engine, engine.step + 1, count, state);
    engine.step += count;
    check(engine, state);
    if (looked_at) watch.fast(engine);
  }
}

// The engine of the state, which has the grains from now on. Whatever goes wrong the state has them back.
template <class Work>
auto with_engine(DemState& state, const ContactLaws& laws, Work&& work) {
  if (!state.engine.held) state.engine.held = std::make_shared<Engine>();
  Engine& engine = *std::static_pointer_cast<Engine>(state.engine.held);
  try {
    enter(engine, state, laws);
    return work(engine);
  } catch (...) {
    leave(engine, state);
    throw;
  }
}

}  // namespace

void add_forces(Engine& engine) { (engine.keep_ledger ? forces_with_ledger : forces_without_ledger)(engine); }

void prepare(DemState& state, const ContactLaws& laws) {
  state.engine = {};
  with_engine(state, laws, [&](Engine& engine) {
    engine.dt = 0;  // springs stay 0
    add_forces(engine);
    if (engine.keep_ledger) enter_losses(engine, 0, 1, state);
    engine.dt = state.dt;
    state.rebuilds = 1;
    check(engine, state);
  });
  fast::hand_back(state);
}

void advance(DemState& state, const ContactLaws& laws, std::int64_t steps, const Watch& watch) {
  with_engine(state, laws, [&](Engine& engine) {
    take_steps(engine, state, steps, watch);
    state.step = engine.step;
  });
}

Observation observe(DemState& state, const ContactLaws& laws) {
  return with_engine(state, laws, [&](Engine& engine) { return observe(engine, state); });
}

void hand_back(DemState& state) {
  if (state.engine.held) leave(*std::static_pointer_cast<Engine>(state.engine.held), state);
}

}  // namespace bagnold::dem::fast

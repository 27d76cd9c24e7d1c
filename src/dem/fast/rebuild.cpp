// Rows in the order of space, and lists from the places where grains are.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/core.h>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "dem/fast/engine.hpp"
#include "dem/neighbours.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

namespace {

void place_rows(Engine& engine, const Grains& g, const neighbours::CellGrid& grid, const std::vector<Vec3>& start) {
  const std::size_t rows = start.size() + engine.rows_beside() * at(grid.slabs);
  engine.grain.assign(rows, nobody);
  engine.species.assign(engine.one_kind ? 0 : rows, 0);
  engine.row.resize(start.size());
  engine.start.assign(rows, Vec3{});
  engine.slabs.assign(static_cast<std::size_t>(grid.slabs), {});
  const std::size_t cells = static_cast<std::size_t>(grid.count[1]) * static_cast<std::size_t>(grid.count[2]);
  parallel_for(
      grid.slabs,
      [&](std::int64_t n) {
        const std::size_t s = at(n), first = at(grid.cell_begin[s * cells]),
                          last = at(grid.cell_begin[(s + 1) * cells]);
        Slab& slab = engine.slabs[s];
        std::size_t row = slab.begin = first + engine.rows_beside() * s;
        for (const bool flowing : {true, false}) {
          for (std::size_t q = first; q < last; ++q) {
            const auto i = at(grid.order[q]);
            if ((static_cast<std::int64_t>(i) < g.flowing) != flowing) continue;
            engine.grain[row] = static_cast<std::int32_t>(i);
            if (!engine.one_kind) engine.species[row] = g.species[i];
            engine.start[row] = start[i];
            engine.row[i] = static_cast<std::uint32_t>(row++);
          }
          if (flowing) slab.moving_end = row;
        }
        slab.end = row;
        for (std::size_t w = 0; w < engine.walls.size(); ++w) {
          engine.grain[engine.wall_row(slab, w)] = -1 - static_cast<std::int32_t>(w);
          if (!engine.one_kind) engine.species[engine.wall_row(slab, w)] = engine.walls[w].species;
        }
      },
      rows >= 500);
}

// Rows of `doubles` numbers in their new order; `was`: where that of each grain was. finish(row, slab, k) may change row k.
// `sorted` is memory to write to, and afterwards that of the old rows: fresh memory costs more than the copying.
template <std::size_t doubles, class Finish>
void permute(const Engine& engine, Aligned<double>& rows, Aligned<double>& sorted,
             const std::vector<std::uint32_t>& was, Finish&& finish) {
  sorted.resize(engine.grain.size() * doubles);
  parallel_for(
      static_cast<std::int64_t>(engine.slabs.size()),
      [&](std::int64_t s) {
        const Slab& slab = engine.slabs[at(s)];
        for (std::size_t k = slab.begin; k < slab.end + engine.rows_beside(); ++k) {
          double* row = &sorted[doubles * k];
          if (k < slab.end)
            std::memcpy(row, &rows[doubles * was[at(engine.grain[k])]], doubles * sizeof(double));
          else
            std::fill_n(row, doubles, 0.0);
          finish(row, slab, k);
        }
      },
      engine.grain.size() >= 500);
  rows.swap(sorted);
}

// Nothing that is not a number, nothing faster than half a diameter per step.
bool is_sound(const Engine& engine) {
  const auto slab_is_sound = [&](std::int64_t s) {
    bool sound = true;
    for (std::size_t k = engine.slabs[at(s)].begin; k < engine.slabs[at(s)].moving_end; ++k) {
      const double *x = &engine.rows.position[position_doubles * k], *v = &engine.rows.velocity[velocity_doubles * k];
      const double limit = v[3] / engine.dt, speed2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
      const double place2 = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
      sound = sound && speed2 <= limit * limit && place2 <= std::numeric_limits<double>::max();
    }
    return sound;
  };
  return parallel_all(static_cast<std::int64_t>(engine.slabs.size()), slab_is_sound, engine.grain.size() >= 500);
}

// Positions of all grains, those that flow wrapped into the box.
std::vector<Vec3> wrapped_positions(const Engine& engine, DemState& state) {
  const Grains& g = state.grains;
  std::vector<Vec3> x(engine.row.size());
  state.ledger.wrapped -= parallel_sum<double>(static_cast<std::int64_t>(x.size()), [&](std::int64_t i) {
    const double* row = &engine.rows.position[position_doubles * engine.row[at(i)]];
    const Vec3 r{row[0], row[1], row[2]};
    x[at(i)] = wrap(engine.box, r);
    return i < g.flowing ? g.mass[at(i)] * dot(engine.gravity, x[at(i)] - r) : 0.0;
  });
  return x;
}

}  // namespace

void arrange(Engine& engine, const Grains& g, const std::vector<Vec3>& start) {
  neighbours::CellGrid grid;
  neighbours::sort_into_cells(grid, engine.box, start, engine.cutoff);
  grid.slabs = grid.count[0];
  place_rows(engine, g, grid, start);
  std::vector<std::size_t> sizes;
  for (const Slab& slab : engine.slabs) sizes.push_back(slab.end - slab.begin);
  engine.ring = make_ring(sizes, steps_per_pass);
  list_outer(engine, g, grid, start);
  list_walls(engine, g);
}

namespace {

// The part of a velocity that changes no distance from a wall.
Vec3 along_walls(const Engine& engine, Vec3 velocity) {
  std::vector<Vec3> across;  // an orthonormal base of the normals
  for (const Wall& wall : engine.walls) {
    Vec3 rest = wall.normal;
    for (const Vec3& n : across) rest -= dot(rest, n) * n;
    if (norm(rest) > 1e-6) across.push_back(rest / norm(rest));
  }
  for (const Vec3& n : across) velocity -= dot(velocity, n) * n;
  return velocity;
}

}  // namespace

void measure(Engine& engine) {
  struct Extremes {
    Vec3 lo, hi;
  };
  const bool all_flow =
      std::all_of(engine.slabs.begin(), engine.slabs.end(), [](const Slab& s) { return s.moving_end == s.end; });
  constexpr double far = std::numeric_limits<double>::infinity();
  const Extremes none =
      all_flow ? Extremes{{far, far, far}, {-far, -far, -far}} : Extremes{};  // fixed grains are at rest
  std::vector<Extremes> velocity(engine.slabs.size(), none);
  parallel_for(
      static_cast<std::int64_t>(engine.slabs.size()),
      [&](std::int64_t s) {
        Slab& slab = engine.slabs[at(s)];
        Extremes v = none;
        for (std::size_t k = slab.begin; k < slab.moving_end; ++k) {
          const double *f = &engine.rows.force[force_doubles * k], *u = &engine.rows.velocity[velocity_doubles * k];
          slab.acceleration = std::max(slab.acceleration, norm(f[3] * Vec3{f[0], f[1], f[2]} + engine.gravity));
          for (int d = 0; d < 3; ++d) {
            v.lo[d] = std::min(v.lo[d], u[d]);
            v.hi[d] = std::max(v.hi[d], u[d]);
          }
        }
        velocity[at(s)] = v;
      },
      engine.grain.size() >= 500);
  Extremes all = none;
  for (const Extremes& v : velocity)
    for (int d = 0; d < 3; ++d) {
      all.lo[d] = std::min(all.lo[d], v.lo[d]);
      all.hi[d] = std::max(all.hi[d], v.hi[d]);
    }
  engine.frame = along_walls(engine, 0.5 * (all.lo + all.hi));
  engine.built_at = engine.step;
}

void start_path(Engine& engine, const DemState& state) {
  if (!audit(engine))
    throw NumericalError(fmt::format("step {} (t = {:g}): grains move too far per step; the step is too long",
                                     state.step, state.time()));
}

void rebuild(Engine& engine, DemState& state) {
  state.step = engine.step;
  if (!is_sound(engine)) {
    leave(engine, state);
    check_motion(state);
    state.pairs.origin.clear();  // rounded the other way
    ++state.rebuilds;
    return load(engine, state, ContactLaws(engine.laws));
  }
  const PairList touching = touching_pairs(engine);
  const std::vector<WallTouch> at_walls = wall_touches(engine);
  const std::vector<Vec3> x = wrapped_positions(engine, state);
  const std::vector<std::uint32_t> was = engine.row;
  engine.sections.clear();
  arrange(engine, state.grains, x);
  {
    Aligned<double> sorted;
    permute<position_doubles>(engine, engine.rows.position, sorted, was,
                              [&](double* row, const Slab& slab, std::size_t k) {
                                if (k < slab.end) std::copy_n(&x[at(engine.grain[k])].x, 3, row);
                                if (k == slab.end + 1)
                                  row[0] = 0.3 * state.grains.diameter[0];  // the two that never touch
                              });
  }
  {
    static_assert(velocity_doubles == force_doubles);
    Aligned<double> sorted;
    permute<velocity_doubles>(engine, engine.rows.velocity, sorted, was, [](double*, const Slab&, std::size_t) {});
    permute<force_doubles>(engine, engine.rows.force, sorted, was, [](double* row, const Slab& slab, std::size_t k) {
      if (k >= slab.moving_end) std::fill_n(row, force_doubles, 0.0);  // forces on the base are nobody's business
    });
  }
  open_ledger(engine);
  measure(engine);
  list_inner(engine, touching);
  remember_walls(engine, at_walls);
  ++state.rebuilds;
  start_path(engine, state);
}

}  // namespace bagnold::dem::fast

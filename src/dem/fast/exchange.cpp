// Between the plain state and the sorted copy.
#include <fmt/core.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "dem/fast/engine.hpp"
#include "dem/neighbours.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

namespace {

double largest_diameter(const Grains& g) { return *std::max_element(g.diameter.begin(), g.diameter.end()); }

double skin_of(const Grains& g) { return 0.24 * *std::min_element(g.diameter.begin(), g.diameter.begin() + g.flowing); }

void choose_kernel(Engine& engine, const Grains& g) {
  engine.equal_radii = std::all_of(g.diameter.begin(), g.diameter.end(), [&](double d) { return d == g.diameter[0]; });
  with_laws(engine.laws, [&](const auto& tables) {
    engine.constant_numbers = flatten_tables(tables, engine.constants);
    engine.history_numbers = Kernel<std::decay_t<decltype(tables)>, true, true>::history_numbers;
  });
  engine.one_kind = true;
  for (std::size_t k = 0; k < engine.constants.size(); ++k)
    engine.one_kind = engine.one_kind && engine.constants[k] == engine.constants[k % engine.constant_numbers];
}

// Where the outer list starts: now, unless the state remembers.
void set_start(Engine& engine, DemState& state, std::vector<Vec3>& start) {
  Grains& g = state.grains;
  if (state.pairs.origin.empty()) {
    check_motion(state);
    wrap_positions(state);
    engine.built_at = state.step;
    Vec3 lo, hi;  // fixed grains are at rest
    if (g.flowing == g.size()) lo = hi = g.v[0];
    for (std::size_t i = 0; i < at(g.flowing); ++i)
      for (int k = 0; k < 3; ++k) {
        lo[k] = std::min(lo[k], g.v[i][k]);
        hi[k] = std::max(hi[k], g.v[i][k]);
      }
    engine.frame = 0.5 * (lo + hi);
    state.pairs.reference.assign(g.x.begin(), g.x.begin() + g.flowing);
  } else {
    engine.built_at = static_cast<std::int64_t>(state.pairs.origin[0]);
    engine.frame = {state.pairs.origin[1], state.pairs.origin[2], state.pairs.origin[3]};
  }
  start = g.x;
  std::copy(state.pairs.reference.begin(), state.pairs.reference.end(), start.begin());
}

void place_rows(Engine& engine, const Grains& g, const neighbours::CellGrid& grid, const std::vector<Vec3>& start) {
  const std::size_t rows = start.size() + 2 * static_cast<std::size_t>(grid.slabs);
  engine.grain.assign(rows, -1);
  engine.species.assign(rows, 0);
  engine.row.resize(start.size());
  engine.start.assign(rows, Vec3{});
  engine.slabs.assign(static_cast<std::size_t>(grid.slabs), {});
  const std::size_t cells = static_cast<std::size_t>(grid.count[1]) * static_cast<std::size_t>(grid.count[2]);
  std::size_t row = 0;
  for (std::size_t s = 0; s < engine.slabs.size(); ++s) {
    Slab& slab = engine.slabs[s];
    slab.begin = row;
    for (const bool flowing : {true, false}) {
      for (auto q = at(grid.cell_begin[s * cells]); q < at(grid.cell_begin[(s + 1) * cells]); ++q) {
        const auto i = at(grid.order[q]);
        if ((static_cast<std::int64_t>(i) < g.flowing) != flowing) continue;
        engine.grain[row] = static_cast<std::int32_t>(i);
        engine.species[row] = g.species[i];
        engine.start[row] = start[i];
        engine.row[i] = row++;
      }
      if (flowing) slab.moving_end = row;
    }
    slab.end = row;
    row += 2;
  }
}

void fill_rows(Engine& engine, const Grains& g) {
  Rows& rows = engine.rows;
  rows.resize(engine.grain.size());
  for (std::size_t k = 0; k < engine.grain.size(); ++k) {
    double *x = &rows.position[position_doubles * k], *v = &rows.velocity[velocity_doubles * k],
           *f = &rows.force[force_doubles * k];
    if (engine.grain[k] < 0) {  // radius 0, and its companion a little away
      x[0] = engine.grain[k - 1] < 0 ? 0.0 : 0.3 * g.diameter[0];
      continue;
    }
    const auto i = at(engine.grain[k]);
    const bool flows = engine.grain[k] < g.flowing;
    const double radius = 0.5 * g.diameter[i], mass = flows ? 1 / g.mass[i] : 0, inertia = flows ? 1 / g.inertia[i] : 0;
    const std::array<double, 4> position{g.x[i].x, g.x[i].y, g.x[i].z, radius};
    const std::array<double, 8> velocity{g.v[i].x,     g.v[i].y,     g.v[i].z,     radius,
                                         g.omega[i].x, g.omega[i].y, g.omega[i].z, mass};
    const std::array<double, 8> force{g.force[i].x,  g.force[i].y,  g.force[i].z,  mass,
                                      g.torque[i].x, g.torque[i].y, g.torque[i].z, inertia};
    std::copy(position.begin(), position.end(), x);
    std::copy(velocity.begin(), velocity.end(), v);
    std::copy(force.begin(), force.end(), f);
    if (!flows) std::fill_n(f, 3, 0.0), std::fill_n(f + 4, 3, 0.0);
  }
  for (Slab& slab : engine.slabs)
    for (std::size_t k = slab.begin; k < slab.moving_end; ++k) {
      const double* f = &rows.force[force_doubles * k];
      slab.acceleration = std::max(slab.acceleration, norm(f[3] * Vec3{f[0], f[1], f[2]} + engine.gravity));
    }
}

// First inner lists, and the springs of the pairs that touch.
void list_inner(Engine& engine, const PairList& remembered) {
  std::vector<std::uint32_t> begin(engine.grain.size() + 1, 0);
  const auto rows_of = [&](std::size_t p) {
    const std::size_t a = engine.row[at(remembered.i[p])], b = engine.row[at(remembered.j[p])];
    return std::pair{std::min(a, b), std::max(a, b)};
  };
  for (std::size_t p = 0; p < remembered.i.size(); ++p)
    if (remembered.touching[p]) ++begin[rows_of(p).first + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::uint32_t> contact(begin.back()), next(begin.begin(), begin.end() - 1);
  for (std::size_t p = 0; p < remembered.i.size(); ++p)
    if (remembered.touching[p]) contact[next[rows_of(p).first]++] = static_cast<std::uint32_t>(p);

  parallel_for(static_cast<std::int64_t>(engine.sections.size()), [&](std::int64_t s) {
    Section& section = engine.sections[at(s)];
    section.inner.count = 0;
    section.history.assign(8 * engine.history_numbers, 0);
    section.mid_valid = section.inner_valid = {};
    refresh(engine, at(s), engine.scratch[at(omp_get_thread_num())]);
    for (std::size_t k = 0; k < section.inner.count; ++k) {
      const std::size_t i = row_of(section.inner.i[k]), j = row_of(section.inner.j[k]);
      for (std::uint32_t c = begin[std::min(i, j)]; c < begin[std::min(i, j) + 1]; ++c) {
        const std::size_t p = contact[c];
        if (rows_of(p).second != std::max(i, j)) continue;
        const double sign = engine.row[at(remembered.i[p])] == i ? 1 : -1;
        double* h = &section.history[k / 8 * 8 * engine.history_numbers + k % 8];
        for (int d = 0; d < 3; ++d) {
          h[8 * d] = sign * remembered.spring[p][d];
          if (engine.history_numbers > 3) h[24 + 8 * d] = sign * remembered.roll[p][d];
        }
      }
    }
  });
}

}  // namespace

bool supports(const DemState& state) {
  const Grains& g = state.grains;
  if (!available || state.keep_ledger || !state.walls.empty() || g.flowing < fewest_grains) return false;
  for (int k = 0; k < 3; ++k)
    if (state.box.periodic[at(k)] && state.box.length[k] < 2 * (largest_diameter(g) + 2 * skin_of(g))) return false;
  return true;
}

bool matches(const Engine& engine, const DemState& state, const ContactLaws& laws) {
  const Grains& g = state.grains;
  if (engine.step != state.step || engine.dt != state.dt || engine.gravity != state.gravity ||
      engine.overlap_ratio != state.max_overlap_ratio || engine.row.size() != g.x.size() || state.pairs.origin.empty())
    return false;
  for (int k = 0; k < 3; ++k)
    if (engine.box.length[k] != state.box.length[k] || engine.box.periodic[at(k)] != state.box.periodic[at(k)])
      return false;
  const bool same_laws = with_laws(laws, [&](const auto& tables) {
    std::vector<double> constants;
    flatten_tables(tables, constants);
    return constants == engine.constants && tables.species == engine.laws.species &&
           laws.normal.index() == engine.laws.normal.index() &&
           laws.tangential.index() == engine.laws.tangential.index() &&
           laws.rolling.index() == engine.laws.rolling.index();
  });
  if (!same_laws) return false;
  for (std::size_t i = 0; i < at(g.flowing); ++i) {
    const std::size_t k = engine.row[i];
    const double *x = &engine.rows.position[position_doubles * k], *v = &engine.rows.velocity[velocity_doubles * k];
    const double* f = &engine.rows.force[force_doubles * k];
    const auto same = [](const Vec3& a, const double* b) { return a.x == b[0] && a.y == b[1] && a.z == b[2]; };
    if (!same(g.x[i], x) || !same(g.v[i], v) || !same(g.omega[i], v + 4) || !same(g.force[i], f) ||
        !same(g.torque[i], f + 4) || 0.5 * g.diameter[i] != x[3] || 1 / g.mass[i] != f[3] || 1 / g.inertia[i] != f[7])
      return false;
  }
  return true;
}

void load(Engine& engine, DemState& state, const ContactLaws& laws) {
  const Grains& g = state.grains;
  engine.laws = laws;
  engine.box = state.box;
  engine.gravity = state.gravity;
  engine.dt = state.dt;
  engine.overlap_ratio = state.max_overlap_ratio;
  engine.skin = skin_of(g);
  engine.step = state.step;
  engine.images = {};
  for (int k = 0; k < 3; ++k)
    if (state.box.periodic[at(k)]) {
      engine.images.length[k] = state.box.length[k];
      engine.images.inverse[k] = 1 / state.box.length[k];
    }
  choose_kernel(engine, g);

  std::vector<Vec3> start;
  set_start(engine, state, start);
  neighbours::CellGrid grid;
  neighbours::sort_into_cells(grid, engine.box, start, largest_diameter(g) + engine.skin);
  grid.slabs = grid.count[0];
  engine.ring = make_ring(grid.slabs, steps_per_pass);
  place_rows(engine, g, grid, start);
  fill_rows(engine, g);
  list_outer(engine, g, grid, start);
  engine.scratch.resize(std::max(engine.scratch.size(), at(threads())));
  list_inner(engine, state.pairs);

  for (std::size_t s = 0; s < engine.slabs.size() && !state.pairs.origin.empty(); ++s) {
    const double* audited = &state.pairs.origin[4 + 4 * s];
    engine.slabs[s].excursion = audited[0];
    engine.slabs[s].drift = {audited[1], audited[2]};
    engine.slabs[s].steps_left = static_cast<std::int64_t>(audited[3]);
  }
  if (state.pairs.origin.empty() && !audit(engine))
    throw NumericalError(fmt::format("step {} (t = {:g}): grains move too far per step; the step is too long",
                                     state.step, state.time()));
}

void store(const Engine& engine, DemState& state) {
  Grains& g = state.grains;
  state.step = engine.step;
  parallel_for(g.flowing, [&](std::int64_t n) {
    const auto i = at(n), k = engine.row[at(n)];
    const double *x = &engine.rows.position[position_doubles * k], *v = &engine.rows.velocity[velocity_doubles * k];
    const double* f = &engine.rows.force[force_doubles * k];
    g.x[i] = {x[0], x[1], x[2]};
    g.v[i] = {v[0], v[1], v[2]};
    g.omega[i] = {v[4], v[5], v[6]};
    g.force[i] = {f[0], f[1], f[2]};
    g.torque[i] = {f[4], f[5], f[6]};
  });
  PairList& pairs = state.pairs;
  for (auto* numbers : {&pairs.i, &pairs.j}) numbers->clear();
  for (auto* vectors : {&pairs.spring, &pairs.roll}) vectors->clear();
  pairs.image.clear();
  for (const Section& section : engine.sections)
    for (std::size_t k = 0; k < section.inner.count; ++k) {
      const auto a = row_of(section.inner.i[k]), b = row_of(section.inner.j[k]);
      const double *xa = &engine.rows.position[position_doubles * a], *xb = &engine.rows.position[position_doubles * b];
      Vec3 r{xa[0] - xb[0], xa[1] - xb[1], xa[2] - xb[2]};
      std::array<int, 3> image{};
      for (int d = 0; d < 3; ++d) {
        image[at(d)] = static_cast<int>(std::nearbyint(engine.images.inverse[d] * r[d]));
        r[d] -= engine.images.length[d] * image[at(d)];
      }
      const double* h = &section.history[k / 8 * 8 * engine.history_numbers + k % 8];
      Vec3 spring{h[0], h[8], h[16]}, roll{};
      if (engine.history_numbers > 3) roll = {h[24], h[32], h[40]};
      const double reach = xa[3] + xb[3];  // the kernel may have rounded a grazing contact the other way
      if (norm2(r) >= reach * reach && spring == Vec3{} && roll == Vec3{}) continue;
      std::int32_t i = engine.grain[a], j = engine.grain[b];
      auto code = neighbours::image_code(image[0], image[1], image[2]);
      if (i > j) {
        std::swap(i, j);
        code = neighbours::opposite(code);
        spring = -spring;
        roll = -roll;
      }
      pairs.i.push_back(i);
      pairs.j.push_back(j);
      pairs.image.push_back(code);
      pairs.spring.push_back(spring);
      pairs.roll.push_back(roll);
    }
  pairs.touching.assign(pairs.i.size(), 1);
  pairs.slab_begin = {0, static_cast<std::int64_t>(pairs.i.size())};
  pairs.origin = {static_cast<double>(engine.built_at), engine.frame.x, engine.frame.y, engine.frame.z};
  for (const Slab& slab : engine.slabs)
    for (const double number :
         {slab.excursion, slab.drift.speed, slab.drift.distance, static_cast<double>(slab.steps_left)})
      pairs.origin.push_back(number);
}

}  // namespace bagnold::dem::fast

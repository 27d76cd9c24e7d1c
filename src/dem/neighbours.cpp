#include "dem/neighbours.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "dem/contact_laws.hpp"

namespace bagnold::dem {

namespace {

using neighbours::Image;

// A touching pair between two lists.
struct Remembered {
  std::int32_t i, j;
  Image image;
  Vec3 spring, roll;
};

struct Listed {
  std::int32_t i, j;
  Image image;
};

std::array<int, 3> steps_to_box(const Box& box, const Vec3& x) {
  std::array<int, 3> steps{};
  for (int k = 0; k < 3; ++k)
    if (box.periodic[at(k)]) steps[at(k)] = static_cast<int>(std::floor((x[k] - box.origin[k]) / box.length[k]));
  return steps;
}

// Touching pairs with their images as they will be once every grain is wrapped into the box.
std::vector<Remembered> remember(const DemState& state) {
  const PairList& pairs = state.pairs;
  std::vector<Remembered> kept;
  for (std::size_t p = 0; p < pairs.i.size(); ++p) {
    if (!pairs.touching[p]) continue;
    auto image = neighbours::image_steps(pairs.image[p]);
    const auto from = steps_to_box(state.box, state.grains.x[at(pairs.i[p])]);
    const auto to = steps_to_box(state.box, state.grains.x[at(pairs.j[p])]);
    for (std::size_t k = 0; k < 3; ++k) image[k] += to[k] - from[k];
    kept.push_back(
        {pairs.i[p], pairs.j[p], neighbours::image_code(image[0], image[1], image[2]), pairs.spring[p], pairs.roll[p]});
  }
  return kept;
}

template <class T>
void permute(std::vector<T>& values, const std::vector<std::int32_t>& source, std::size_t offset = 0) {
  std::vector<T> sorted(source.size());
  for (std::size_t i = 0; i < source.size(); ++i) sorted[i] = values[offset + at(source[i])];
  std::copy(sorted.begin(), sorted.end(), values.begin() + static_cast<std::ptrdiff_t>(offset));
}

// Grains in the order of their cells, flowing before fixed: neighbours in space become neighbours in memory.
void reorder_grains(DemState& state, const neighbours::CellGrid& grid, std::vector<Remembered>& kept) {
  Grains& g = state.grains;
  std::vector<std::int32_t> source = grid.order;
  std::stable_partition(source.begin(), source.end(), [&](std::int32_t i) { return i < g.flowing; });
  for (auto* values : {&g.x, &g.v, &g.omega, &g.force, &g.torque}) permute(*values, source);
  for (auto* values : {&g.diameter, &g.mass, &g.inertia}) permute(*values, source);
  permute(g.species, source);
  permute(g.id, source);

  std::vector<std::int32_t> place(source.size());
  for (std::size_t i = 0; i < source.size(); ++i) place[at(source[i])] = static_cast<std::int32_t>(i);
  for (Remembered& k : kept) {
    k.i = place[at(k.i)];
    k.j = place[at(k.j)];
    if (k.i < k.j) continue;
    std::swap(k.i, k.j);  // seen from the other side
    k.image = neighbours::opposite(k.image);
    k.spring = -k.spring;
    k.roll = -k.roll;
  }
  source.resize(at(g.flowing));
  for (std::size_t w = 0; w < state.walls.size(); ++w) {
    permute(state.wall_contacts.touching, source, w * at(g.flowing));
    permute(state.wall_contacts.spring, source, w * at(g.flowing));
    permute(state.wall_contacts.roll, source, w * at(g.flowing));
  }
}

// Pairs within contact distance plus skin whose first point lies in `slab`.
void list_slab(const DemState& state, const neighbours::CellGrid& grid, const std::array<Vec3, 27>& shift, int slab,
               std::vector<Listed>& out) {
  const Grains& g = state.grains;
  out.clear();
  neighbours::for_each_pair(grid, slab, [&](std::int32_t a, std::int32_t b, Image image) {
    if (a == b || (a >= g.flowing && b >= g.flowing)) return;
    const double reach = 0.5 * (g.diameter[at(a)] + g.diameter[at(b)]) + state.skin;
    if (norm2(g.x[at(a)] - g.x[at(b)] - shift[image]) >= reach * reach) return;
    if (a < b)
      out.push_back({a, b, image});
    else
      out.push_back({b, a, neighbours::opposite(image)});
  });
}

// Writes the listed pairs into the state and gives touching ones their history back.
void store(DemState& state, const std::vector<std::vector<Listed>>& listed, int slabs, std::vector<Remembered>& kept) {
  PairList& pairs = state.pairs;
  pairs.slab_begin.assign(1, 0);
  for (int s = 0; s < slabs; ++s)
    pairs.slab_begin.push_back(pairs.slab_begin.back() + static_cast<std::int64_t>(listed[at(s)].size()));
  const auto n = at(pairs.slab_begin.back());
  pairs.i.resize(n);
  pairs.j.resize(n);
  pairs.image.resize(n);
  pairs.touching.assign(n, 0);
  pairs.spring.assign(n, Vec3{});
  pairs.roll.assign(n, Vec3{});

  std::vector<std::int64_t> row(at(state.grains.size()) + 1, 0);  // remembered contacts by i
  for (const Remembered& k : kept) ++row[at(k.i) + 1];
  std::partial_sum(row.begin(), row.end(), row.begin());
  std::stable_sort(kept.begin(), kept.end(), [](const Remembered& a, const Remembered& b) { return a.i < b.i; });

  parallel_for(
      slabs,
      [&](std::int64_t s) {
        auto p = at(pairs.slab_begin[at(s)]);
        for (const Listed& pair : listed[at(s)]) {
          pairs.i[p] = pair.i;
          pairs.j[p] = pair.j;
          pairs.image[p] = pair.image;
          for (auto k = at(row[at(pair.i)]); k < at(row[at(pair.i) + 1]); ++k) {
            if (kept[k].j != pair.j || kept[k].image != pair.image) continue;
            pairs.touching[p] = 1;
            pairs.spring[p] = kept[k].spring;
            pairs.roll[p] = kept[k].roll;
          }
          ++p;
        }
      },
      worth_threads(state.grains));
}

}  // namespace

double default_skin(const Grains& grains) {
  if (grains.flowing == 0) return 0;
  return 0.12 * *std::min_element(grains.diameter.begin(), grains.diameter.begin() + grains.flowing);
}

void check_motion(const DemState& state) {
  const Grains& g = state.grains;
  for (std::int64_t i = 0; i < g.flowing; ++i) {
    const double moved = norm(g.v[at(i)]) * state.dt;
    const char* cause = !(std::isfinite(norm2(g.x[at(i)])) && std::isfinite(moved))
                            ? "position or velocity is not finite"
                        : moved > 0.5 * g.diameter[at(i)] ? "moved by more than half its diameter in one step"
                                                          : nullptr;
    if (cause != nullptr)
      throw NumericalError(
          fmt::format("grain {} at step {} (t = {:g}): {}", g.id[at(i)], state.step, state.time(), cause));
  }
}

void wrap_positions(DemState& state) {
  Grains& g = state.grains;
  for (std::int64_t i = 0; i < g.size(); ++i) {
    const Vec3 wrapped = wrap(state.box, g.x[at(i)]);
    if (i < g.flowing) state.ledger.wrapped -= g.mass[at(i)] * dot(state.gravity, wrapped - g.x[at(i)]);
    g.x[at(i)] = wrapped;
  }
}

void rebuild_pairs(DemState& state) {
  check_motion(state);
  Grains& g = state.grains;
  std::vector<Remembered> kept = remember(state);
  wrap_positions(state);

  const double largest = g.size() == 0 ? 1 : *std::max_element(g.diameter.begin(), g.diameter.end());
  neighbours::CellGrid grid;
  neighbours::sort_into_cells(grid, state.box, g.x, largest + state.skin);
  if (state.reorder_every > 0 && state.step >= state.next_reorder) {
    reorder_grains(state, grid, kept);
    state.next_reorder = state.step + state.reorder_every;
    neighbours::sort_into_cells(grid, state.box, g.x, largest + state.skin);
  }
  const auto shift = neighbours::image_shifts(state.box);
  std::vector<std::vector<Listed>> listed(at(grid.slabs));
  parallel_for(
      grid.slabs, [&](std::int64_t s) { list_slab(state, grid, shift, static_cast<int>(s), listed[at(s)]); },
      worth_threads(g));
  store(state, listed, grid.slabs, kept);
  state.pairs.reference.assign(g.x.begin(), g.x.begin() + g.flowing);
  state.pairs.origin.clear();
  ++state.rebuilds;
}

void refresh_pairs(DemState& state) {
  const Grains& g = state.grains;
  const double limit = 0.25 * state.skin * state.skin;
  const bool fresh =
      state.pairs.origin.empty() && parallel_all(
                                        g.flowing,
                                        [&](std::int64_t i) {  // not so for NaN
                                          return norm2(g.x[at(i)] - state.pairs.reference[at(i)]) <= limit;
                                        },
                                        worth_threads(g));
  if (!fresh) rebuild_pairs(state);
}

}  // namespace bagnold::dem

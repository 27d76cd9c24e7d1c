// Lists of grains near walls, and their springs out of old lists and into new ones.
#include "dem/fast/walls.hpp"

#include "core/parallel.hpp"
#include "dem/fast/engine.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

namespace {

// More than half the skin, which grains stay within: the rest covers rounding.
constexpr double reserve = 0.51;

void append(WallList& list, std::size_t wall, std::size_t in_last, Offset i, Offset j) {
  if (in_last == 0) {
    list.batches.push_back({static_cast<std::uint32_t>(wall), 0});
    list.i.resize(list.i.size() + batch);
    list.j.resize(list.j.size() + batch);
  }
  ++list.batches.back().count;
  const std::size_t end = list.i.size();
  for (std::size_t k = end - batch + in_last; k < end; ++k) {
    list.i[k] = i;
    list.j[k] = j;
  }
}

// f(grain, wall, place of its first number in the history) for every grain of the list.
template <class F>
void for_listed(const Engine& engine, const WallList& list, F&& f) {
  for (std::size_t b = 0; b < list.batches.size(); ++b)
    for (std::size_t k = 0; k < list.batches[b].count; ++k)
      f(row_of(list.i[b * batch + k]), list.batches[b].wall, b * batch * engine.history_numbers + k);
}

}  // namespace

void list_walls(Engine& engine, const Grains& g) {
  if (engine.walls.empty()) return;
  parallel_for(
      static_cast<std::int64_t>(engine.slabs.size()),
      [&](std::int64_t s) {
        const Slab& slab = engine.slabs[at(s)];
        WallList& list = engine.sections[at(s)].walls;
        list = {};
        for (std::size_t w = 0; w < engine.walls.size(); ++w) {
          std::size_t found = 0;
          for (std::size_t row = slab.begin; row < slab.moving_end; ++row) {
            const double near = 0.5 * g.diameter[at(engine.grain[row])] + reserve * engine.skin;
            if (height_above(engine.walls[w], engine.start[row]) < near)
              append(list, w, found++ % batch, offset_of(row), offset_of(engine.wall_row(slab, w)));
          }
        }
        list.history.assign(list.i.size() * engine.history_numbers, 0.0);
        if (engine.one_kind) return;
        for (std::size_t k = 0; k < list.i.size(); ++k)
          list.kind.push_back(kind_of(engine, row_of(list.i[k]), row_of(list.j[k])));
      },
      engine.grain.size() >= 500);
}

std::vector<WallTouch> wall_touches(const Engine& engine) {
  std::vector<WallTouch> touches;
  for (const Section& section : engine.sections)
    for_listed(engine, section.walls, [&](std::size_t row, std::size_t wall, std::size_t place) {
      const double *x = &engine.rows.position[position_doubles * row], *h = &section.walls.history[place];
      WallTouch touch{at(engine.grain[row]), wall, {h[0], h[8], h[16]}, {}};
      if (engine.history_numbers > 3) touch.roll = {h[24], h[32], h[40]};
      // The kernel may have rounded a grazing contact the other way.
      if (height_above(engine.walls[wall], {x[0], x[1], x[2]}) < x[3] || touch.spring != Vec3{} || touch.roll != Vec3{})
        touches.push_back(touch);
    });
  return touches;
}

void remember_walls(Engine& engine, const std::vector<WallTouch>& touches) {
  if (touches.empty()) return;
  const std::size_t grains = engine.row.size();
  std::vector<std::uint32_t> touch(grains * engine.walls.size(), 0);  // number of the touch, from 1
  for (std::size_t k = 0; k < touches.size(); ++k)
    touch[touches[k].wall * grains + touches[k].grain] = static_cast<std::uint32_t>(k + 1);
  for (Section& section : engine.sections)
    for_listed(engine, section.walls, [&](std::size_t row, std::size_t wall, std::size_t place) {
      const std::uint32_t number = touch[wall * grains + at(engine.grain[row])];
      if (number == 0) return;
      double* h = &section.walls.history[place];
      for (int d = 0; d < 3; ++d) {
        h[8 * d] = touches[number - 1].spring[d];
        if (engine.history_numbers > 3) h[24 + 8 * d] = touches[number - 1].roll[d];
      }
    });
}

std::vector<WallTouch> wall_touches(const DemState& state) {
  const WallContacts& at_walls = state.wall_contacts;
  std::vector<WallTouch> touches;
  for (std::size_t k = 0; k < at_walls.touching.size(); ++k)
    if (at_walls.touching[k])
      touches.push_back(
          {k % at(state.grains.flowing), k / at(state.grains.flowing), at_walls.spring[k], at_walls.roll[k]});
  return touches;
}

void give_walls(const Engine& engine, DemState& state) {
  const std::size_t places = engine.walls.size() * at(state.grains.flowing);
  WallContacts& at_walls = state.wall_contacts;
  at_walls.touching.assign(places, 0);
  at_walls.spring.assign(places, Vec3{});
  at_walls.roll.assign(places, Vec3{});
  for (const WallTouch& t : wall_touches(engine)) {
    const std::size_t k = t.wall * at(state.grains.flowing) + t.grain;
    at_walls.touching[k] = 1;
    at_walls.spring[k] = t.spring;
    at_walls.roll[k] = t.roll;
  }
}

}  // namespace bagnold::dem::fast

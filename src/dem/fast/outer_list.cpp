// The outer list from the cells, eight candidates at a time: the places that for_each_range() names are neighbours in
// memory once the grains are copied in the order of the cells.
#include <algorithm>

#include "core/parallel.hpp"
#include "dem/fast/engine.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

namespace {

struct InCellOrder {
  Aligned<double> x, y, z, radius;
  Aligned<double> fixed;  // huge for fixed grains, so that two of them are never near each other; 0 for others
  Aligned<Offset> row;
  explicit InCellOrder(std::size_t n) {
    for (auto* numbers : {&x, &y, &z, &radius, &fixed}) numbers->resize(n);
    row.resize(n);
  }
};

InCellOrder arrange(const Engine& engine, const Grains& g, const neighbours::CellGrid& grid,
                    const std::vector<Vec3>& start) {
  InCellOrder in(grid.order.size() + batch);  // whole packs may be read
  parallel_for(static_cast<std::int64_t>(grid.order.size()), [&](std::int64_t place) {
    const auto p = static_cast<std::size_t>(place), i = static_cast<std::size_t>(grid.order[p]);
    in.x[p] = start[i].x;
    in.y[p] = start[i].y;
    in.z[p] = start[i].z;
    in.radius[p] = 0.5 * g.diameter[i];
    in.fixed[p] = grid.order[p] < g.flowing ? 0 : 1e100;
    in.row[p] = offset_of(engine.row[i]);
  });
  return in;
}

void make_room(Section& section, std::size_t n) {
  if (section.outer_i.size() >= n) return;
  for (auto* rows : {&section.outer_i, &section.outer_j}) rows->resize(n + n / 8);
}

}  // namespace

void list_outer(Engine& engine, const Grains& g, const neighbours::CellGrid& grid, const std::vector<Vec3>& start) {
  const auto shift = neighbours::image_shifts(engine.box);
  const InCellOrder in = arrange(engine, g, grid, start);
  engine.sections.resize(engine.slabs.size());
  parallel_for(static_cast<std::int64_t>(engine.sections.size()), [&](std::int64_t s) {
    Section& section = engine.sections[static_cast<std::size_t>(s)];
    const Slab& slab = engine.slabs[static_cast<std::size_t>(s)];
    make_room(section, 6 * (slab.end - slab.begin));  // what a dense flow needs
    std::size_t count = 0;
    const auto list = [&](std::int32_t place, std::int32_t begin, std::int32_t end, neighbours::Image image) {
      const auto p = static_cast<std::size_t>(place), last = static_cast<std::size_t>(end);
      make_room(section, count + last - static_cast<std::size_t>(begin) + batch);
      Offset *i = section.outer_i.data() + count, *j = section.outer_j.data() + count;
      const Offset row = in.row[p];
      const Lanes x = in.x[p] - shift[image].x, y = in.y[p] - shift[image].y, z = in.z[p] - shift[image].z;
      const Lanes reach = in.radius[p] + engine.skin, fixed = in.fixed[p];
      for (auto q = static_cast<std::size_t>(begin); q < last; q += batch) {
        const Vec3Of<Lanes> r{x - Lanes::load_unaligned(&in.x[q]), y - Lanes::load_unaligned(&in.y[q]),
                              z - Lanes::load_unaligned(&in.z[q])};
        const Lanes near = reach + Lanes::load_unaligned(&in.radius[q]);
        std::uint32_t bits = to_integer(dot(r, r) < near * near - fixed * Lanes::load_unaligned(&in.fixed[q]));
        if (last - q < batch) bits &= (1u << (last - q)) - 1;
        std::fill_n(i, batch, row);
        const int found = compress(bits, &in.row[q], j);
        i += found;
        j += found;
      }
      count = static_cast<std::size_t>(i - section.outer_i.data());
    };
    neighbours::for_each_range(grid, static_cast<int>(s), list);
    section.outer_count = count;
    make_room(section, count + batch);
    for (std::size_t k = count; k < count + batch; ++k) {
      section.outer_i[k] = offset_of(slab.end);
      section.outer_j[k] = offset_of(slab.end + 1);
    }
  });
}

}  // namespace bagnold::dem::fast

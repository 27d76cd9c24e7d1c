// The outer list from the cells: eight of the points near a cell at a time are compared with each of its own.
#include <algorithm>

#include "core/parallel.hpp"
#include "dem/fast/engine.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

namespace {

// Points side by side.
struct Points {
  Aligned<double> x, y, z, radius;
  Aligned<double>
      seen_by_fixed;  // their radius; hugely negative for fixed grains: two of them are never near each other
  Aligned<Offset> row;
  void make_room(std::size_t n) {
    if (row.size() >= n + batch) return;  // whole packs may be read
    for (auto* numbers : {&x, &y, &z, &radius, &seen_by_fixed}) numbers->resize(n + batch);
    row.resize(n + batch);
  }
};

Points in_cell_order(const Engine& engine, const Grains& g, const neighbours::CellGrid& grid,
                     const std::vector<Vec3>& start) {
  Points in;
  in.make_room(grid.order.size());
  parallel_for(static_cast<std::int64_t>(grid.order.size()), [&](std::int64_t place) {
    const auto p = static_cast<std::size_t>(place), i = static_cast<std::size_t>(grid.order[p]);
    in.x[p] = start[i].x;
    in.y[p] = start[i].y;
    in.z[p] = start[i].z;
    in.radius[p] = 0.5 * g.diameter[i];
    in.seen_by_fixed[p] = grid.order[p] < g.flowing ? in.radius[p] : -1e100;
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
  const Points in = in_cell_order(engine, g, grid, start);
  const Lanes skin = engine.skin, zero = 0.0;
  engine.sections.resize(engine.slabs.size());
  parallel_for(static_cast<std::int64_t>(engine.sections.size()), [&](std::int64_t s) {
    Section& section = engine.sections[static_cast<std::size_t>(s)];
    const Slab& slab = engine.slabs[static_cast<std::size_t>(s)];
    make_room(section, 6 * (slab.end - slab.begin));  // what a dense flow needs
    std::size_t count = 0;
    Offset *i = nullptr, *j = nullptr;
    const auto compare = [&](std::size_t first, std::size_t last, const neighbours::NearRange& near, bool own) {
      const auto end = static_cast<std::size_t>(near.end);
      const Vec3Of<Lanes> moved{shift[near.image].x, shift[near.image].y, shift[near.image].z};
      for (auto q = static_cast<std::size_t>(near.begin); q < end; q += batch) {
        const Vec3Of<Lanes> x = Vec3Of<Lanes>{Lanes::load_unaligned(&in.x[q]), Lanes::load_unaligned(&in.y[q]),
                                              Lanes::load_unaligned(&in.z[q])} +
                                moved;
        const Lanes reach = Lanes::load_unaligned(&in.radius[q]) + skin;
        const Lanes reach_of_fixed = Lanes::load_unaligned(&in.seen_by_fixed[q]) + skin;
        const std::uint32_t there = end - q < batch ? (1u << (end - q)) - 1 : 255;
        for (std::size_t p = first; p < last; ++p) {
          const Vec3Of<Lanes> r{x.x - Lanes(in.x[p]), x.y - Lanes(in.y[p]), x.z - Lanes(in.z[p])};
          const Lanes near_by = max((in.seen_by_fixed[p] < 0 ? reach_of_fixed : reach) + Lanes(in.radius[p]), zero);
          std::uint32_t bits = to_integer(dot(r, r) < near_by * near_by) & there;
          if (own && p >= q) bits &= p - q < batch ? ~0u << (p - q + 1) : 0u;  // each pair once
          std::fill_n(i, batch, in.row[p]);
          const int found = compress(bits, &in.row[q], j);
          i += found;
          j += found;
        }
      }
    };
    neighbours::for_each_cell(grid, static_cast<int>(s),
                              [&](std::int32_t begin, std::int32_t end, std::span<const neighbours::NearRange> near) {
                                const auto first = static_cast<std::size_t>(begin),
                                           last = static_cast<std::size_t>(end);
                                std::size_t most = batch;
                                neighbours::NearRange own{begin, end, neighbours::same_image};
                                if (!near.empty() && near[0].begin == end && near[0].image == neighbours::same_image) {
                                  own.end = near[0].end;
                                  near = near.subspan(1);
                                }
                                most += (last - first) * static_cast<std::size_t>(own.end - own.begin);
                                for (const neighbours::NearRange& range : near)
                                  most += (last - first) * static_cast<std::size_t>(range.end - range.begin);
                                make_room(section, count + most);
                                i = section.outer_i.data() + count;
                                j = section.outer_j.data() + count;
                                compare(first, last, own, true);
                                for (const neighbours::NearRange& range : near) compare(first, last, range, false);
                                count = static_cast<std::size_t>(i - section.outer_i.data());
                              });
    section.outer_count = count;
    make_room(section, count + batch);
    for (std::size_t k = count; k < count + batch; ++k) {
      section.outer_i[k] = offset_of(slab.end);
      section.outer_j[k] = offset_of(slab.end + 1);
    }
  });
}

}  // namespace bagnold::dem::fast

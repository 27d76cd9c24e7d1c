// Points sorted into cells, and all pairs closer than a cell, each once, in an order that does not depend on threads.
// Works for any box: with fewer than three cells in a periodic direction a pair appears once per image that is near.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/box.hpp"
#include "core/vec3.hpp"

namespace bagnold::neighbours {

// Which periodic image of j is meant: x_j + shift. Codes 0..26 stand for shifts by -1, 0, 1 box lengths.
using Image = std::uint8_t;
constexpr Image image_code(int a, int b, int c) { return static_cast<Image>((a + 1) + 3 * (b + 1) + 9 * (c + 1)); }
constexpr std::array<int, 3> image_steps(Image code) { return {code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1}; }
constexpr Image opposite(Image code) { return static_cast<Image>(26 - code); }
inline constexpr Image same_image = image_code(0, 0, 0);
std::array<Vec3, 27> image_shifts(const Box& box);

// Cells are stored with the direction of most cells (a periodic one if it has nearly as many) slowest; layers of cells along it form slabs. The pairs of slab
// s involve points of slabs s and s + 1 only, so slabs of one parity can be worked on at the same time.
struct CellGrid {
  std::array<int, 3> axis{0, 1, 2};   // directions, slowest first
  std::array<int, 3> count{1, 1, 1};  // cells along axis[k]
  std::array<bool, 3> periodic{};     // along axis[k]
  Vec3 origin{}, cell{};              // by direction
  int slabs = 1;
  std::vector<std::int32_t> cell_begin;  // points of cell c: order[cell_begin[c] .. cell_begin[c + 1])
  std::vector<std::int32_t> order;
  std::vector<std::int32_t> cell_of;
  std::int32_t layer_begin(int slab) const { return static_cast<std::int32_t>(std::int64_t{slab} * count[0] / slabs); }
};

// Sorts `x` (inside the box in periodic directions) into cells no smaller than `cutoff`.
// Throws UnphysicalError when a periodic length is below `cutoff`.
void sort_into_cells(CellGrid& grid, const Box& box, std::span<const Vec3> x, double cutoff);

// Places [begin, end) in `order` of points that are met as that image.
struct NearRange {
  std::int32_t begin, end;
  Image image;
};

// f(first, last, near) for every cell of `slab` that holds points, at the places [first, last): their near points are the others
// of the cell and those in `near`, and in this way each pair of near points is met once.
template <class F>
void for_each_cell(const CellGrid& grid, int slab, F&& f) {
  const auto [n0, n1, n2] = grid.count;
  const auto begin_of = [&](int c0, int c1, int c2) {
    return grid.cell_begin[static_cast<std::size_t>((c0 * n1 + c1) * n2 + c2)];
  };
  // The neighbour cell along axis k, its image step; false outside a box that does not repeat.
  const auto step = [&](int k, int n, int& c, int& image) {
    image = c < 0 ? -1 : c >= n ? 1 : 0;
    c -= image * n;
    return image == 0 || grid.periodic[static_cast<std::size_t>(k)];
  };
  std::array<NearRange, 15> near;
  for (int c0 = grid.layer_begin(slab); c0 < grid.layer_begin(slab + 1); ++c0)
    for (int c1 = 0; c1 < n1; ++c1)
      for (int c2 = 0; c2 < n2; ++c2) {
        const std::int32_t first = begin_of(c0, c1, c2), last = begin_of(c0, c1, c2 + 1);
        if (first == last) continue;
        std::size_t ranges = 0;
        // Cells c2 + from .. c2 + 1 of a row of cells lie side by side, but for a periodic image at either end.
        const auto add_row = [&](int o0, int o1, int from) {
          int a = c0 + o0, b = c1 + o1;
          std::array<int, 3> image{};
          auto &along0 = image[static_cast<std::size_t>(grid.axis[0])],
               &along1 = image[static_cast<std::size_t>(grid.axis[1])],
               &along2 = image[static_cast<std::size_t>(grid.axis[2])];
          if (!step(0, n0, a, along0) || !step(1, n1, b, along1)) return;
          const auto add = [&](int lo, int hi, int steps) {
            along2 = steps;
            if (lo > hi) return;
            const NearRange range{begin_of(a, b, lo), begin_of(a, b, hi + 1), image_code(image[0], image[1], image[2])};
            if (range.begin < range.end) near[ranges++] = range;
          };
          if (grid.periodic[2] && c2 + from < 0) add(n2 - 1, n2 - 1, -1);
          add(std::max(c2 + from, 0), std::min(c2 + 1, n2 - 1), 0);
          if (grid.periodic[2] && c2 + 1 >= n2) add(0, 0, 1);
        };
        add_row(0, 0, 1);
        add_row(0, 1, -1);
        for (int o1 = -1; o1 <= 1; ++o1) add_row(1, o1, -1);
        f(first, last, std::span<const NearRange>(near.data(), ranges));
      }
}

// f(i, j, image) for pairs whose first point lies in `slab`: every pair closer than the cutoff, and some others.
template <class F>
void for_each_pair(const CellGrid& grid, int slab, F&& f) {
  for_each_cell(grid, slab, [&](std::int32_t first, std::int32_t last, std::span<const NearRange> near) {
    for (std::int32_t p = first; p < last; ++p) {
      const std::int32_t i = grid.order[static_cast<std::size_t>(p)];
      for (std::int32_t q = p + 1; q < last; ++q) f(i, grid.order[static_cast<std::size_t>(q)], same_image);
      for (const NearRange& r : near)
        for (std::int32_t q = r.begin; q < r.end; ++q) f(i, grid.order[static_cast<std::size_t>(q)], r.image);
    }
  });
}

}  // namespace bagnold::neighbours

// Points sorted into cells, and all pairs closer than a cell, each once, in an order that does not depend on threads.
// Works for any box: with fewer than three cells in a periodic direction a pair appears once per image that is near.
#pragma once
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

// Cells are stored with the direction of most cells slowest; layers of cells along it form slabs. The pairs of slab
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

// f(i, j, image) for pairs whose first point lies in `slab`: every pair closer than the cutoff, and some others.
template <class F>
void for_each_pair(const CellGrid& grid, int slab, F&& f) {
  const auto [n0, n1, n2] = grid.count;
  // The neighbour cell along axis k, its image step; false outside a box that does not repeat.
  const auto step = [&](int k, int n, int& c, int& image) {
    image = c < 0 ? -1 : c >= n ? 1 : 0;
    c -= image * n;
    return image == 0 || grid.periodic[static_cast<std::size_t>(k)];
  };
  const auto with_cell = [&](std::int32_t i, int c0, int c1, int c2) {
    std::array<int, 3> along{}, image{};
    if (!step(0, n0, c0, along[0]) || !step(1, n1, c1, along[1]) || !step(2, n2, c2, along[2])) return;
    for (std::size_t k = 0; k < 3; ++k) image[static_cast<std::size_t>(grid.axis[k])] = along[k];
    const auto code = image_code(image[0], image[1], image[2]);
    const auto c = static_cast<std::size_t>((c0 * n1 + c1) * n2 + c2);
    for (auto q = grid.cell_begin[c]; q < grid.cell_begin[c + 1]; ++q)
      f(i, grid.order[static_cast<std::size_t>(q)], code);
  };
  const int first = grid.layer_begin(slab) * n1 * n2, last = grid.layer_begin(slab + 1) * n1 * n2;
  for (int home = first; home < last; ++home) {
    const int c0 = home / (n1 * n2), c1 = home / n2 % n1, c2 = home % n2;
    const auto end = grid.cell_begin[static_cast<std::size_t>(home) + 1];
    for (auto p = grid.cell_begin[static_cast<std::size_t>(home)]; p < end; ++p) {
      const auto i = grid.order[static_cast<std::size_t>(p)];
      for (auto q = p + 1; q < end; ++q) f(i, grid.order[static_cast<std::size_t>(q)], same_image);
      with_cell(i, c0, c1, c2 + 1);
      for (int o2 = -1; o2 <= 1; ++o2) with_cell(i, c0, c1 + 1, c2 + o2);
      for (int o1 = -1; o1 <= 1; ++o1)
        for (int o2 = -1; o2 <= 1; ++o2) with_cell(i, c0 + 1, c1 + o1, c2 + o2);
    }
  }
}

}  // namespace bagnold::neighbours

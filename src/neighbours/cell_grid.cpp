#include "neighbours/cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.hpp"

namespace bagnold::neighbours {

std::array<Vec3, 27> image_shifts(const Box& box) {
  std::array<Vec3, 27> shifts;
  for (int code = 0; code < 27; ++code) {
    const auto steps = image_steps(static_cast<Image>(code));
    for (std::size_t k = 0; k < 3; ++k)
      shifts[static_cast<std::size_t>(code)][static_cast<int>(k)] = steps[k] * box.length[static_cast<int>(k)];
  }
  return shifts;
}

namespace {

// Number and size of the cells in each direction. Where the box does not repeat they cover the points. Cells grow
// when the points are spread so thin that most cells would be empty.
std::array<int, 3> shape_cells(CellGrid& grid, const Box& box, std::span<const Vec3> x, double cutoff) {
  std::array<int, 3> count{};
  Vec3 extent;
  const double given = cutoff;
  cutoff *= 1 + 1e-9;  // so that rounding cannot put two close points two cells apart
  for (int k = 0; k < 3; ++k) {
    double length = box.length[k];
    grid.origin[k] = box.origin[k];
    if (!box.periodic[static_cast<std::size_t>(k)]) {
      double lo = x.empty() ? 0 : x[0][k], hi = lo;
      for (const Vec3& p : x) lo = std::min(lo, p[k]), hi = std::max(hi, p[k]);
      grid.origin[k] = lo;
      length = hi - lo;
    } else if (length < given) {
      throw UnphysicalError("box", "a periodic length is below the largest grain plus the neighbour margin");
    }
    extent[k] = length;
    count[static_cast<std::size_t>(k)] = static_cast<int>(std::clamp(std::floor(length / cutoff), 1.0, 1e6));
  }
  const double most = 4096.0 + 8.0 * static_cast<double>(x.size());
  while (1.0 * count[0] * count[1] * count[2] > most) *std::max_element(count.begin(), count.end()) /= 2;
  for (int k = 0; k < 3; ++k) grid.cell[k] = std::max(cutoff, extent[k] / count[static_cast<std::size_t>(k)]);
  return count;
}

// Width of an even distribution with the same mean distance from its middle: a few points far from the rest hardly count.
double spread(std::span<const Vec3> x, int k) {
  const double n = std::max(1.0, static_cast<double>(x.size()));
  double sum = 0, distance = 0;
  for (const Vec3& p : x) sum += p[k];
  for (const Vec3& p : x) distance += std::abs(p[k] - sum / n);
  return 4 * distance / n;
}

}  // namespace

void sort_into_cells(CellGrid& grid, const Box& box, std::span<const Vec3> x, double cutoff) {
  const std::array<int, 3> count = shape_cells(grid, box, x, cutoff);
  grid.axis = {0, 1, 2};
  // Slabs along a periodic direction hold about as much each; those along the height of a flow do not.
  std::array<double, 3> rank{};
  for (int k = 0; k < 3; ++k)
    rank[static_cast<std::size_t>(k)] = box.periodic[static_cast<std::size_t>(k)]
                                            ? 2.0 * count[static_cast<std::size_t>(k)]
                                            : spread(x, k) / grid.cell[k];
  std::stable_sort(grid.axis.begin(), grid.axis.end(),
                   [&](int a, int b) { return rank[static_cast<std::size_t>(a)] > rank[static_cast<std::size_t>(b)]; });
  for (std::size_t k = 0; k < 3; ++k) {
    grid.count[k] = count[static_cast<std::size_t>(grid.axis[k])];
    grid.periodic[k] = box.periodic[static_cast<std::size_t>(grid.axis[k])];
  }
  // Even, so that slabs of one parity never share points, also around a periodic box.
  grid.slabs = grid.count[0] < 2 ? 1 : std::min(grid.count[0] / 2 * 2, 64);

  const auto cells = static_cast<std::size_t>(grid.count[0]) * static_cast<std::size_t>(grid.count[1]) *
                     static_cast<std::size_t>(grid.count[2]);
  grid.cell_begin.assign(cells + 1, 0);
  grid.cell_of.resize(x.size());
  grid.order.resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    std::int32_t c = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const int d = grid.axis[k];
      const int along = static_cast<int>((x[i][d] - grid.origin[d]) / grid.cell[d]);
      c = c * grid.count[k] + std::clamp(along, 0, grid.count[k] - 1);
    }
    grid.cell_of[i] = c;
    ++grid.cell_begin[static_cast<std::size_t>(c) + 1];
  }
  std::partial_sum(grid.cell_begin.begin(), grid.cell_begin.end(), grid.cell_begin.begin());
  for (std::size_t i = x.size(); i-- > 0;)  // backwards: cell_begin + count becomes cell_begin, order stays stable
    grid.order[static_cast<std::size_t>(--grid.cell_begin[static_cast<std::size_t>(grid.cell_of[i]) + 1])] =
        static_cast<std::int32_t>(i);
  for (std::size_t c = 0; c < cells; ++c) grid.cell_begin[c] = grid.cell_begin[c + 1];
  grid.cell_begin[cells] = static_cast<std::int32_t>(x.size());
}

}  // namespace bagnold::neighbours

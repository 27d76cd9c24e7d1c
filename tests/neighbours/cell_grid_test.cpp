// Every close pair is found once per image, against all pairs and all images.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

#include "core/error.hpp"
#include "core/random.hpp"
#include "neighbours/cell_grid.hpp"

namespace bagnold::neighbours {
namespace {

using Key = std::tuple<int, int, int>;

std::vector<Vec3> points(const Box& box, int n, std::uint64_t seed) {
  std::vector<Vec3> x(static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < x.size(); ++i)
    for (int k = 0; k < 3; ++k)
      x[i][k] =
          box.origin[k] + box.length[k] * random::uniform(seed, random::Stream::test, i, static_cast<std::uint32_t>(k));
  return x;
}

void expect_all_pairs(const Box& box, const std::vector<Vec3>& x, double cutoff) {
  CellGrid grid;
  sort_into_cells(grid, box, x, cutoff);
  const auto shift = image_shifts(box);
  std::set<Key> found;
  for (int slab = 0; slab < grid.slabs; ++slab)
    for_each_pair(grid, slab, [&](int i, int j, Image image) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      if (norm(x[a] - x[b] - shift[image]) >= cutoff) return;
      const Key key = i < j ? Key{i, j, image} : Key{j, i, opposite(image)};
      EXPECT_TRUE(found.insert(key).second) << "listed twice";
      const auto slab_of = [&](std::size_t p) {
        const int layer = grid.cell_of[p] / (grid.count[1] * grid.count[2]);
        int s = 0;
        while (layer >= grid.layer_begin(s + 1)) ++s;
        return s;
      };
      EXPECT_EQ(slab_of(a), slab);
      EXPECT_TRUE(slab_of(b) == slab || slab_of(b) == (slab + 1) % grid.slabs);
    });
  std::set<Key> expected;
  for (int i = 0; i < static_cast<int>(x.size()); ++i)
    for (int j = i + 1; j < static_cast<int>(x.size()); ++j)
      for (int code = 0; code < 27; ++code) {
        const auto steps = image_steps(static_cast<Image>(code));
        bool exists = true;
        for (std::size_t k = 0; k < 3; ++k) exists = exists && (steps[k] == 0 || box.periodic[k]);
        if (exists && norm(x[static_cast<std::size_t>(i)] - x[static_cast<std::size_t>(j)] -
                           shift[static_cast<std::size_t>(code)]) < cutoff)
          expected.insert({i, j, code});
      }
  EXPECT_EQ(found, expected);
}

TEST(CellGrid, FindsEveryPairOnceInBoxesOfAnyShape) {
  const std::array<Vec3, 6> lengths{Vec3{1, 1, 1},    {1.05, 2.2, 3.3}, {9, 1, 2},
                                    {2.0, 2.0, 11.0}, {3.01, 5, 7.7},   {12.3, 4.4, 1.7}};
  std::uint64_t seed = 0;
  for (const Vec3& length : lengths)
    for (int periodic = 0; periodic < 8; ++periodic) {
      const Box box{{-3, 0.5, 100}, length, {(periodic & 1) != 0, (periodic & 2) != 0, (periodic & 4) != 0}};
      expect_all_pairs(box, points(box, 60, ++seed), 1.0);
    }
}

TEST(CellGrid, PointsSpreadFarApartDoNotExhaustMemory) {
  const Box box{};
  std::vector<Vec3> x = points(box, 20, 5);
  x.push_back({1e12, 0, 0});
  x.push_back({0, -1e9, 1e9});
  expect_all_pairs(box, x, 0.4);
}

TEST(CellGrid, SlabsOfAChuteLieAlongItWhateverIsThrownUp) {
  std::vector<Vec3> x;
  for (int k = 0; k < 4000; ++k) x.push_back({0.05 + k % 200 * 0.1, 0.5 + k / 200 % 10, k / 2000 * 10.0 + k % 10});
  for (int k = 0; k < 20; ++k) x.push_back({1, 1, 200.0 + k});
  CellGrid grid;
  sort_into_cells(grid, {{0, 0, 0}, {20, 10, 1}, {true, true, false}}, x, 1.24);
  EXPECT_EQ(grid.axis[0], 0);
}

TEST(CellGrid, OddNumbersOfLayersKeepSlabsOfOneParityApart) {
  for (const double layers : {2.5, 3.5, 5.5, 7.5, 130.5}) {
    const Box box{{}, {layers, 1, 1}, {true, true, true}};
    const auto x = points(box, 50, 9);
    CellGrid grid;
    sort_into_cells(grid, box, x, 1);
    EXPECT_EQ(grid.slabs % 2, 0);
    EXPECT_LE(grid.slabs, 64);
  }
}

TEST(CellGrid, RefusesABoxSmallerThanTheCutoff) {
  const Box box{{}, {0.9, 5, 5}, {true, true, true}};
  CellGrid grid;
  EXPECT_THROW(sort_into_cells(grid, box, points(box, 3, 1), 1), UnphysicalError);
}

}  // namespace
}  // namespace bagnold::neighbours

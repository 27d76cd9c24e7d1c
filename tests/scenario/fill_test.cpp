// Random filling: no overlaps, inside the region, the same whatever the order of the world.
#include "scenario/fill.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace bagnold::scenario {
namespace {

double smallest_gap(const Box& box, const std::vector<Vec3>& x, const std::vector<double>& d,
                    const std::vector<Sphere>& others) {
  double gap = 1e300;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      gap = std::min(gap, norm(minimum_image(box, x[i] - x[j])) - 0.5 * (d[i] + d[j]));
    for (const Sphere& s : others)
      gap = std::min(gap, norm(minimum_image(box, x[i] - s.x)) - 0.5 * (d[i] + s.diameter));
  }
  return gap;
}

TEST(Fill, ChuteFillingIsLooseAndFree) {
  const Box box{{0, 0, 0}, {20, 10, 1}, {true, true, false}};
  const std::vector<double> diameters(1000, 1.0);
  std::vector<Sphere> base;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 10; ++j) base.push_back({{i + 0.5, j + 0.5, -0.1}, 1.0});
  const auto x = fill({.box = box, .height = 5}, diameters, base, 1, random::Stream::fill);
  ASSERT_EQ(x.size(), 1000u);
  EXPECT_GE(smallest_gap(box, x, diameters, base), 0);
  double top = 0;
  for (const Vec3& r : x) {
    top = std::max(top, r.z);
    EXPECT_TRUE(r.x >= 0 && r.x < 20 && r.y >= 0 && r.y < 10 && r.z >= 0);
  }
  const double packing = 1000 * 0.5236 / (200 * (top + 0.5));
  EXPECT_GT(packing, 0.24);  // "initial packing about 0.3"
  EXPECT_LT(packing, 0.36);
}

TEST(Fill, SizesAndCylinderAndFloorAreRespected) {
  const Box box{{-3, -3, 0}, {6, 6, 1}, {false, false, false}};
  std::vector<double> diameters;
  for (int i = 0; i < 200; ++i)
    diameters.push_back(0.3 + 0.3 * random::uniform(3, random::Stream::sizes, static_cast<std::uint64_t>(i)));
  const auto x = fill({.box = box, .solid_floor = true, .height = 2, .cylinder_radius = 2}, diameters, {}, 7,
                      random::Stream::fill);
  EXPECT_GE(smallest_gap(box, x, diameters, {}), 0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_LE(std::hypot(x[i].x, x[i].y), 2 - 0.5 * diameters[i] + 1e-12);
    EXPECT_GE(x[i].z, 0.5 * diameters[i]);
  }
}

TEST(Fill, ScalesBitwiseWithTheUnitOfLength) {
  const auto scaled = [](double unit) {
    const Box box{{0, 0, 0}, {8 * unit, 4 * unit, unit}, {true, true, false}};
    return fill({.box = box, .height = 3 * unit, .growth = 1e-4 * unit}, std::vector<double>(60, unit), {}, 5,
                random::Stream::fill);
  };
  const auto a = scaled(1), b = scaled(16);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(16.0 * a[i], b[i]);
}

TEST(Fill, AnotherSeedIsAnotherFilling) {
  const Box box{{0, 0, 0}, {4, 4, 1}, {true, true, false}};
  const FillRegion region{.box = box, .height = 3};
  const std::vector<double> diameters(20, 1.0);
  EXPECT_EQ(fill(region, diameters, {}, 1, random::Stream::fill), fill(region, diameters, {}, 1, random::Stream::fill));
  EXPECT_NE(fill(region, diameters, {}, 1, random::Stream::fill), fill(region, diameters, {}, 2, random::Stream::fill));
}

}  // namespace
}  // namespace bagnold::scenario

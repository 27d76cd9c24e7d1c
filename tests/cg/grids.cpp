// Grids of every dimension against each other: averaging a finer resolution gives the coarser one, images make the seam
// invisible, and the balances hold in 3D.
#include <gtest/gtest.h>

#include <cmath>

#include "cg/fields.hpp"
#include "cg/grid.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "packing.hpp"

using namespace bagnold;

namespace {

std::vector<cg::Row> sums_on(const cg::Grid& grid, const laws::CgKernels::Any& kernel, const cg::StoredSnapshot& s) {
  std::vector<cg::Row> sums;
  cg::add_snapshot(sums, grid, kernel, s.view());
  return sums;
}

}  // namespace

// The mean of a periodic x-z plane over x is the z profile; the mean of the 3D field over y is the x-z plane (Gaussian: its
// marginals are Gaussians). Node sums over a period converge faster than any power, so few nodes will do.
TEST(Grid, AveragingTheFinerGridGivesTheCoarser) {
  const auto s = test::random_packing(21, 40, 10, 80);
  const laws::CgKernels::Any kernel = laws::CgGaussian{0.4};
  const auto z = cg::make_grid(s.box, {false, false, true}, -1, 9, 0.5);
  const auto xz = cg::make_grid(s.box, {true, false, true}, -1, 9, 0.5);
  cg::Grid fine_xz = xz;
  fine_xz.count[0] = 36;
  fine_xz.spacing.x = 6.0 / 36;
  cg::Grid xyz = xz;
  xyz.resolved[1] = true;
  xyz.count[1] = 30;
  xyz.spacing.y = 5.0 / 30;
  const auto profile = sums_on(z, kernel, s), plane = sums_on(fine_xz, kernel, s),
             coarse_plane = sums_on(xz, kernel, s), space = sums_on(xyz, kernel, s);
  for (std::size_t c = 0; c < cg::kChannels; ++c) {
    for (std::int64_t k = 0; k < z.count[2]; ++k) {
      double mean = 0;
      for (std::int64_t i = 0; i < 36; ++i) mean += plane[static_cast<std::size_t>(i + 36 * k)][c] / 36;
      EXPECT_NEAR(mean, profile[static_cast<std::size_t>(k)][c], 1e-9) << c;
    }
    for (std::int64_t k = 0; k < xz.count[2]; ++k)
      for (std::int64_t i = 0; i < xz.count[0]; ++i) {
        double mean = 0;
        for (std::int64_t j = 0; j < 30; ++j)
          mean += space[static_cast<std::size_t>(i + xz.count[0] * (j + 30 * k))][c] / 30;
        EXPECT_NEAR(mean, coarse_plane[static_cast<std::size_t>(i + xz.count[0] * k)][c], 1e-9) << c;
      }
  }
}

TEST(Grid, TheSeamOfThePeriodicBoxIsInvisible) {
  laws::CgKernels::for_each([](auto kernel) {
    kernel.width = 0.5;
    auto s = test::random_packing(22, 30, 8, 60);
    const auto grid = cg::make_grid(s.box, {true, true, true}, -1, 9, 1);
    const auto before = sums_on(grid, kernel, s);
    // Every grain moves by a whole number of nodes and wraps: fields shift with them.
    for (Vec3& x : s.x) x = wrap(s.box, x + Vec3{2 * grid.spacing.x, 3 * grid.spacing.y, 0});
    const auto after = sums_on(grid, kernel, s);
    const bool jumps = std::string_view(kernel.name) == "heaviside";  // a node may sit on the edge of a ball
    for (std::int64_t k = 0; k < grid.count[2]; ++k)
      for (std::int64_t j = 0; j < grid.count[1]; ++j)
        for (std::int64_t i = 0; i < grid.count[0]; ++i) {
          const std::int64_t to =
              (i + 2) % grid.count[0] + grid.count[0] * ((j + 3) % grid.count[1] + grid.count[1] * k);
          const std::int64_t from = i + grid.count[0] * (j + grid.count[1] * k);
          for (std::size_t c = 0; c < cg::kChannels; ++c)
            EXPECT_NEAR(after[static_cast<std::size_t>(to)][c], before[static_cast<std::size_t>(from)][c],
                        jumps ? 1e-9 : 1e-11);
        }
  });
}

// div sigma = sum F_i W_i at every point of space, by differences of a fine patch: the paths of the base forces, down from the contact
// point, leave no divergence of their own but at the grain.
TEST(Grid, MomentumBalanceHoldsInThreeDimensions) {
  const auto s = test::random_packing(23, 20, 6, 40);
  const laws::CgGaussian gaussian{0.5};
  std::vector<Vec3> force(s.x.size());
  for (const auto& c : s.contacts) {
    force[static_cast<std::size_t>(c.i)] += c.force;
    if (c.j >= 0) force[static_cast<std::size_t>(c.j)] -= c.force;
  }
  const double h = 0.02;
  double peak = 0, worst = 0;
  for (Vec3 r : {Vec3{1.2, 2.1, 0.3}, Vec3{3.3, 0.1, 1.7}, Vec3{5.9, 4.8, 4.4}, Vec3{0.4, 3.3, 6.1}}) {
    const cg::Grid patch{.resolved = {true, true, true},
                         .count = {5, 5, 5},
                         .origin = r - Vec3{2 * h, 2 * h, 2 * h},
                         .spacing = {h, h, h}};
    const auto sums = sums_on(patch, gaussian, s);
    for (std::size_t a = 0; a < 3; ++a) {
      double divergence = 0;
      for (std::size_t b = 0; b < 3; ++b) {
        const std::int64_t stride = b == 0 ? 1 : b == 1 ? 5 : 25;
        const auto at = [&](std::int64_t o) {
          const cg::Row& row = sums[static_cast<std::size_t>(62 + o * stride)];  // 62: the middle
          return row[cg::kContact + 3 * a + b] + row[cg::kBase + 3 * a + b];
        };
        divergence += (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h);
      }
      double carried = 0;
      for (std::size_t i = 0; i < static_cast<std::size_t>(s.flowing); ++i)
        for (int p = -1; p <= 1; ++p)
          for (int q = -1; q <= 1; ++q)
            carried +=
                force[i][static_cast<int>(a)] * gaussian.density(norm2(r - s.x[i] - Vec3{p * 6.0, q * 5.0, 0}), 3);
      peak = std::max(peak, std::abs(carried));
      worst = std::max(worst, std::abs(divergence - carried));
    }
  }
  EXPECT_LT(worst, 1e-5 * peak);  // fourth-order differences
}

TEST(Grid, DoesNotDependOnThreads) {
  const auto s = test::random_packing(24);
  const auto grid = cg::make_grid(s.box, {true, false, true}, -1, 9, 0.4);
  set_threads(1);
  const auto one = sums_on(grid, laws::CgLucy{0.3}, s);
  force_threads(3);
  const auto three = sums_on(grid, laws::CgLucy{0.3}, s);
  set_threads(0);
  EXPECT_EQ(one, three);
}

TEST(Grid, HasToResolveZ) {
  const auto s = test::random_packing(25);
  cg::Grid grid = cg::make_grid(s.box, {true, false, true}, 0, 8, 1);
  grid.resolved[2] = false;
  EXPECT_THROW(sums_on(grid, laws::CgGaussian{}, s), UnphysicalError);
}

// Velocity gradient and temperature of grains that move in simple shear with a known scatter.
namespace {

cg::StoredSnapshot simple_shear() {
  cg::StoredSnapshot s;
  s.box = {.origin = {}, .length = {8, 8, 1}, .periodic = {true, true, false}};
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const auto u = [&](std::uint32_t k) { return test::random_number(5, static_cast<std::uint64_t>(i), k, -1, 1); };
    const double z = 8 * (i + 0.5) / n;
    s.x.push_back({4 + 4 * u(0), 4 + 4 * u(1), z});
    s.v.push_back(Vec3{0.7 * z, 0, 0} + 0.3 * Vec3{u(2), u(3), u(4)});  // variance 0.03 each
    s.omega.push_back({0, 0.35, 0});
    s.diameter.push_back(0.3);
    s.mass.push_back(0.027);
    s.inertia.push_back(0.1 * 0.027 * 0.09);
  }
  s.flowing = n;
  return s;
}

}  // namespace

TEST(Fields, SimpleShearWithThermalScatter) {
  const auto s = simple_shear();
  const std::size_t n = s.x.size();
  const double w = 0.5;
  const auto grid = cg::make_grid(s.box, {false, false, true}, 0, 8, 0.1);
  auto rows = sums_on(grid, laws::CgGaussian{w}, s);
  const auto gradient = cg::gradients(rows, grid, s.box);
  const double least = cg::least_density(rows);
  const std::size_t middle = 40;
  const cg::Local at{rows[middle], gradient[middle], w, least};
  EXPECT_NEAR(cg::field_named("shear_rate").value(at), 0.7, 0.02);
  EXPECT_NEAR(cg::field_named("grad_u_xz").value(at), 0.7, 0.02);
  EXPECT_NEAR(cg::field_named("temperature").value(at), 0.03 + 0.49 * w * w / 3, 1e-3);
  EXPECT_NEAR(cg::field_named("temperature_unsheared").value(at), 0.03, 1e-3);
  EXPECT_NEAR(cg::field_named("omega_y").value(at), 0.35, 1e-12);
  EXPECT_NEAR(cg::field_named("rho").value(at), static_cast<double>(n) * 0.027 / 512, 0.01);
  EXPECT_NEAR(cg::field_named("mean_diameter").value(at), 0.3, 1e-12);
  EXPECT_THROW(cg::field_named("temprature"), InputError);
}

// Of one standard deviation, kernels agree where fields vary on longer scales; the function matters little.
TEST(Fields, KernelsOfOneWidthAgree) {
  const auto s = simple_shear();
  const auto grid = cg::make_grid(s.box, {false, false, true}, 0, 8, 0.1);
  const double w = 0.5;
  const auto value = [&](const laws::CgKernels::Any& kernel, const char* field, std::size_t n) {
    const auto rows = sums_on(grid, kernel, s);
    return cg::field_named(field).value({rows[n], cg::gradients(rows, grid, s.box)[n], w, cg::least_density(rows)});
  };
  for (const char* field : {"rho", "u_x", "temperature", "shear_rate"})
    for (std::size_t n : {30, 40, 50}) {
      const double gauss = value(laws::CgGaussian{w}, field, n), lucy = value(laws::CgLucy{w}, field, n);
      EXPECT_NEAR(lucy, gauss, 0.02 * gauss) << field;
    }
  EXPECT_NEAR(value(laws::CgHeaviside{w}, "temperature", 40), value(laws::CgGaussian{w}, "temperature", 40), 0.005);
}

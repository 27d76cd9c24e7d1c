// The lattice a column of continuum starts from.
#include "scenario/continuum_column.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace bagnold::scenario {
namespace {

// Neither radius nor height is a multiple of dp.
constexpr ContinuumColumn odd{.radius = 0.0972, .height = 0.0535, .spacing = 2.2e-3};

sph::Particles particles_of(const ContinuumColumn& column, ColumnGeometry geometry, std::uint64_t seed = 1) {
  sph::Model model;
  set_geometry(column, geometry, model);
  return make_particles(column, geometry, model, seed);
}

TEST(ContinuumColumn, HasTheSizeAskedForWhateverTheSpacing) {
  for (const auto geometry : {ColumnGeometry::planar, ColumnGeometry::axisymmetric, ColumnGeometry::cylinder}) {
    const auto p = particles_of(odd, geometry);
    const auto& z = p.x[geometry == ColumnGeometry::cylinder ? 2 : 1];
    const auto [low, high] = std::minmax_element(z.begin(), z.end());
    EXPECT_NEAR(*low + *high, odd.height, 1e-12);
    EXPECT_NEAR(*low, odd.height / 48, 1e-12);  // 24 rows
    double volume = 0, reach = 0;
    for (std::size_t i = 0; i < z.size(); ++i) {
      volume += p.mass[i] / p.rho[i];
      reach = std::max(reach, std::abs(p.x[0][i]));
    }
    EXPECT_NEAR(reach, odd.radius * (1 - 0.5 / 44), 1e-12);
    const double cylinder = M_PI * odd.radius * odd.radius * odd.height;
    if (geometry == ColumnGeometry::planar) {
      EXPECT_NEAR(volume / (2 * odd.radius * odd.height), 1, 1e-12);
    } else {
      EXPECT_NEAR(volume / cylinder, 1, geometry == ColumnGeometry::axisymmetric ? 1e-12 : 0.01);
    }
  }
}

TEST(ContinuumColumn, DisorderStaysWithinItsLimitAndDependsOnTheSeed) {
  ContinuumColumn disordered = odd;
  disordered.disorder = 0.01;
  const auto lattice = particles_of(odd, ColumnGeometry::axisymmetric),
             one = particles_of(disordered, ColumnGeometry::axisymmetric),
             again = particles_of(disordered, ColumnGeometry::axisymmetric),
             two = particles_of(disordered, ColumnGeometry::axisymmetric, 2);
  double farthest = 0, apart = 0;
  for (std::size_t d = 0; d < 2; ++d) {
    EXPECT_EQ(one.x[d], again.x[d]);
    for (std::size_t i = 0; i < lattice.x[d].size(); ++i) {
      farthest = std::max(farthest, std::abs(one.x[d][i] - lattice.x[d][i]));
      apart = std::max(apart, std::abs(one.x[d][i] - two.x[d][i]));
    }
  }
  EXPECT_LE(farthest, 0.01 * odd.spacing);
  EXPECT_GT(farthest, 0.0099 * odd.spacing);
  EXPECT_GT(apart, 0.01 * odd.spacing);
  EXPECT_EQ(one.mass, lattice.mass);
}

}  // namespace
}  // namespace bagnold::scenario

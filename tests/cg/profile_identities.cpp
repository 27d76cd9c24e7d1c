// The identities that hold to round-off in every instant, for every kernel, also at the base.
#include <gtest/gtest.h>

#include <cmath>

#include "cg/grid.hpp"
#include "cg/moments.hpp"
#include "core/error.hpp"
#include "packing.hpp"

using namespace bagnold;

namespace {

struct Profile {
  cg::Lattice lattice;
  cg::ProfileSums sums;
  double z(std::size_t n) const { return lattice.node(sums.first + static_cast<std::int64_t>(n)); }
  std::size_t size() const { return sums.value.size(); }
};

Profile profile_of(const std::vector<cg::StoredSnapshot>& snapshots, const laws::CgKernels::Any& kernel,
                   bool averaged = false, double spacing = 0.1, double origin = 0) {
  auto moments = cg::make_moments(kernel, cg::make_lattice(kernel, spacing, origin), snapshots[0].box);
  cg::ProfileScratch scratch;
  for (const auto& s : snapshots) cg::add_snapshot(moments, s.view(), scratch);
  const cg::NodeRange r = cg::reach(moments);
  return {moments.lattice, cg::evaluate(moments, r.first, r.count, averaged)};
}

template <class F>
void for_each_kernel(F f) {
  laws::CgKernels::for_each([&](auto kernel) {
    SCOPED_TRACE(std::string(kernel.name));
    kernel.width = 0.3;
    f(kernel);
  });
}

std::vector<cg::StoredSnapshot> packings(int n) {
  std::vector<cg::StoredSnapshot> out;
  for (int k = 0; k < n; ++k) out.push_back(test::random_packing(static_cast<std::uint64_t>(7 + k)));
  return out;
}

}  // namespace

// The expansions about bin centres against the plain evaluation of every term, for every channel.
TEST(Profile, MatchesDirectEvaluation) {
  for_each_kernel([](const auto& kernel) {
    const auto snapshots = packings(2);
    const Profile p = profile_of(snapshots, kernel, false, 0.1, 0.0123);
    cg::Grid grid;
    grid.count[2] = static_cast<std::int64_t>(p.size());
    grid.origin.z = p.z(0);
    grid.spacing.z = p.lattice.spacing;
    std::vector<cg::Row> direct;
    for (const auto& s : snapshots) cg::add_snapshot(direct, grid, kernel, s.view());
    for (std::size_t c = 0; c < cg::kChannels; ++c) {
      double peak = 0, worst = 0;
      for (const auto& row : direct) peak = std::max(peak, std::abs(row[c]));
      for (std::size_t n = 0; n < p.size(); ++n) worst = std::max(worst, std::abs(p.sums.value[n][c] - direct[n][c]));
      EXPECT_GT(peak, 0) << "channel " << c;
      EXPECT_LT(worst, 1e-10 * peak) << "channel " << c;
    }
  });
}

TEST(Profile, SlopesAreDerivativesOfValues) {
  const laws::CgGaussian kernel{0.3};
  const Profile p = profile_of(packings(1), kernel, false, 0.02);
  for (std::size_t c = 0; c < cg::kChannels; ++c) {
    double peak = 0, worst = 0;
    for (std::size_t n = 3; n + 3 < p.size(); ++n) {
      const auto v = [&](int k) { return p.sums.value[static_cast<std::size_t>(static_cast<int>(n) + k)][c]; };
      const double numeric = (45 * (v(1) - v(-1)) - 9 * (v(2) - v(-2)) + (v(3) - v(-3))) / (60 * p.lattice.spacing);
      peak = std::max(peak, std::abs(p.sums.slope[n][c]));
      worst = std::max(worst, std::abs(p.sums.slope[n][c] - numeric));
    }
    EXPECT_LT(worst, 1e-5 * peak) << "channel " << c;
  }
}

// Mass: the interval means of rho add up to the mass, to round-off.
TEST(Profile, MassIsExact) {
  for_each_kernel([](const auto& kernel) {
    const auto snapshots = packings(3);
    const Profile p = profile_of(snapshots, kernel, true);
    double profile_mass = 0, mass = 0;
    for (const auto& row : p.sums.value) profile_mass += row[cg::kMass] * p.lattice.spacing;
    for (const auto& s : snapshots)
      for (std::int64_t i = 0; i < s.flowing; ++i) mass += s.mass[static_cast<std::size_t>(i)] / 30;
    EXPECT_NEAR(profile_mass, mass, 1e-13 * mass);
  });
}

// Momentum: d sigma_az/dz equals the contact force carried by the grains, point by point, base included. (rho g is the same sum
// on both sides.)
TEST(Profile, StressBalancesTheContactForces) {
  for_each_kernel([](const auto& kernel) {
    const auto snapshots = packings(3);
    const Profile p = profile_of(snapshots, kernel);
    std::vector<std::array<double, 3>> carried(p.size());
    for (const auto& s : snapshots) {
      std::vector<Vec3> force(s.x.size());
      for (const auto& c : s.contacts) {
        force[static_cast<std::size_t>(c.i)] += c.force;
        if (c.j >= 0) force[static_cast<std::size_t>(c.j)] -= c.force;
      }
      for (std::size_t i = 0; i < static_cast<std::size_t>(s.flowing); ++i)
        for (std::size_t n = 0; n < p.size(); ++n)
          for (int a = 0; a < 3; ++a)
            carried[n][static_cast<std::size_t>(a)] += force[i][a] * kernel.derivative(0, p.z(n) - s.x[i].z) / 30;
    }
    double peak = 0, worst = 0;
    for (std::size_t n = 0; n < p.size(); ++n)
      for (std::size_t a = 0; a < 3; ++a) {
        const double divergence = p.sums.slope[n][cg::kContact + 3 * a + 2] + p.sums.slope[n][cg::kBase + 3 * a + 2];
        peak = std::max(peak, std::abs(carried[n][a]));
        worst = std::max(worst, std::abs(divergence - carried[n][a]));
      }
    EXPECT_LT(worst, 1e-11 * peak);
  });
}

// The same over finite intervals and to round-off whatever the expansion neglects: forces per interval telescope.
TEST(Profile, JumpAcrossTheDepthIsTheBaseForce) {
  for_each_kernel([](const auto& kernel) {
    for (int count : {1, 3}) {
      const auto snapshots = packings(count);
      const Profile p = profile_of(snapshots, kernel);
      Vec3 base{};
      for (const auto& s : snapshots)
        for (const auto& c : s.contacts)
          if (c.j < 0 || c.j >= s.flowing) base -= c.force;  // on the base
      for (std::size_t k = 0; k < 9; ++k) {
        EXPECT_NEAR(p.sums.value.back()[cg::kContact + k], 0, 1e-12);
        EXPECT_NEAR(p.sums.value.back()[cg::kBase + k], 0, 1e-12);
        EXPECT_NEAR(p.sums.value.front()[cg::kContact + k], 0, 1e-12);
      }
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_NEAR(p.sums.value.front()[cg::kBase + 3 * a + 2], base[static_cast<int>(a)] / 30, 1e-12);
        EXPECT_NEAR(p.sums.value.front()[cg::kBase + 3 * a], 0, 1e-12);  // sigma_ax ends at the contact point
      }
    }
  });
}

TEST(Profile, DoesNotDependOnWhereTheLatticeBegins) {
  for_each_kernel([](const auto& kernel) {
    const auto snapshots = packings(1);
    const Profile a = profile_of(snapshots, kernel);
    const std::int64_t steps = 3;
    const Profile b = profile_of(snapshots, kernel, false, 0.1, static_cast<double>(steps) * a.lattice.spacing);
    // Shifted by whole nodes: other bins take part, the same places are evaluated.
    double worst = 0;
    for (std::size_t n = 0; n < a.size(); ++n) {
      const std::int64_t m = a.sums.first + static_cast<std::int64_t>(n) - steps - b.sums.first;
      if (m < 0 || m >= static_cast<std::int64_t>(b.size())) continue;
      for (std::size_t c = 0; c < cg::kChannels; ++c)
        worst = std::max(worst, std::abs(a.sums.value[n][c] - b.sums.value[static_cast<std::size_t>(m)][c]));
    }
    EXPECT_LT(worst, 1e-11);
    // Shifted by a part of a bin, evaluated at the same places through the direct sums.
    const Profile shifted = profile_of(snapshots, kernel, false, 0.1, 0.0371);
    cg::Grid grid;
    grid.count[2] = static_cast<std::int64_t>(shifted.size());
    grid.origin.z = shifted.z(0);
    grid.spacing.z = shifted.lattice.spacing;
    std::vector<cg::Row> direct;
    cg::add_snapshot(direct, grid, kernel, snapshots[0].view());
    for (std::size_t n = 0; n < shifted.size(); ++n)
      EXPECT_NEAR(shifted.sums.value[n][cg::kContact], direct[n][cg::kContact], 1e-10);
  });
}

TEST(Profile, DoesNotDependOnThePeriodicOrigin) {
  const laws::CgGaussian kernel{0.3};
  auto snapshots = packings(1);
  const Profile a = profile_of(snapshots, kernel);
  for (Vec3& x : snapshots[0].x) x = wrap(snapshots[0].box, x + Vec3{2.7, -1.9, 0});
  const Profile b = profile_of(snapshots, kernel);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) EXPECT_EQ(a.sums.value[n], b.sums.value[n]);
}

// A grain that left the flow must not take the memory of the machine with it.
TEST(Profile, RefusesAGrainFarAway) {
  auto s = test::random_packing(3);
  s.x[0].z = 1e7;
  EXPECT_THROW(profile_of({s}, laws::CgGaussian{0.3}), NumericalError);
  s.x[0].z = std::nan("");
  EXPECT_THROW(profile_of({s}, laws::CgGaussian{0.3}), NumericalError);
}

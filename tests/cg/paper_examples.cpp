// Figure 1 of Weinhart et al. 2012 against closed forms, and eq. (32) in 3D against an independent quadrature.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cg/grid.hpp"
#include "cg/moments.hpp"
#include "packing.hpp"

using namespace bagnold;

namespace {

double phi(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

// Two unit masses at -1 and +1 on the line (z here), repelling each other with |f| = 1.
cg::StoredSnapshot figure_1(bool lower_is_fixed) {
  cg::StoredSnapshot s;
  s.box = {.origin = {}, .length = {1, 1, 1}, .periodic = {false, false, false}};
  s.x = {{0, 0, 1}, {0, 0, -1}};
  s.v = s.omega = {{}, {}};
  s.diameter = {2.1, 2.1};
  s.mass = {1, 1};
  s.inertia = {0.4, 0.4};
  s.flowing = lower_is_fixed ? 1 : 2;
  dem::Contact c;
  c.i = 0;
  c.j = 1;
  c.branch = {0, 0, 2};
  c.normal = {0, 0, 1};
  c.overlap = 0.1;
  c.force = {0, 0, 1};
  s.contacts = {c};
  return s;
}

template <class Check>
void on_figure_1(bool lower_is_fixed, Check check) {
  const double w = 0.2;
  const laws::CgKernels::Any kernel = laws::CgGaussian{w};
  const auto s = figure_1(lower_is_fixed);
  auto moments = cg::make_moments(kernel, cg::make_lattice(kernel, 0.05), s.box);
  cg::ProfileScratch scratch;
  cg::add_snapshot(moments, s.view(), scratch);
  const cg::ProfileSums sums = cg::evaluate(moments, -60, 121);
  for (std::size_t n = 0; n < sums.value.size(); ++n)
    check(moments.lattice.node(-60 + static_cast<std::int64_t>(n)), w, sums.value[n], sums.slope[n]);
}

double gauss(double z, double w) { return std::exp(-z * z / (2 * w * w)) / (std::sqrt(2 * std::numbers::pi) * w); }

}  // namespace

TEST(Figure1, BothFlowing) {
  on_figure_1(false, [](double z, double w, const cg::Row& value, const cg::Row& slope) {
    EXPECT_NEAR(value[cg::kMass], gauss(z - 1, w) + gauss(z + 1, w), 1e-10 * gauss(0, w));
    const double stress = -(phi((z + 1) / w) - phi((z - 1) / w));  // along the contact line
    EXPECT_NEAR(value[cg::kContact + 8] + value[cg::kBase + 8], stress, 1e-11);
    EXPECT_NEAR(slope[cg::kContact + 8], gauss(z - 1, w) - gauss(z + 1, w), 1e-10);
  });
}

TEST(Figure1, LowerFixed) {
  on_figure_1(true, [](double z, double w, const cg::Row& value, const cg::Row& slope) {
    EXPECT_NEAR(value[cg::kMass], gauss(z - 1, w), 1e-10 * gauss(0, w));
    const double stress = -(1 - phi((z - 1) / w));  // from the flowing grain to minus infinity
    EXPECT_NEAR(value[cg::kContact + 8] + value[cg::kBase + 8], stress, 1e-11);
    EXPECT_NEAR(slope[cg::kBase + 8], gauss(z - 1, w), 1e-10);
  });
}

// The expansions at their worst: one grain anywhere in the widest bins, w/2. Kernel, its integral and its derivative are each within
// 1e-10 of their peak.
TEST(Profile, OneGrainAnywhereIsWithinTenDigits) {
  const double w = 0.25;
  const laws::CgGaussian kernel{w};
  for (int place = 0; place < 50; ++place) {
    auto s = figure_1(true);
    s.x[0].z = w / 2 * place / 49;
    s.contacts[0].branch.z = 3;  // to the contact point at half of it and the overlap
    auto moments = cg::make_moments(kernel, cg::make_lattice(kernel, w / 4), s.box);
    cg::ProfileScratch scratch;
    cg::add_snapshot(moments, s.view(), scratch);
    const cg::ProfileSums sums = cg::evaluate(moments, -40, 81);
    for (std::size_t n = 0; n < sums.value.size(); ++n) {
      const double z = moments.lattice.node(-40 + static_cast<std::int64_t>(n)) - s.x[0].z;
      EXPECT_NEAR(sums.value[n][cg::kMass], gauss(z, w), 1e-10 * gauss(0, w));
      EXPECT_NEAR(sums.slope[n][cg::kMass], -z / (w * w) * gauss(z, w), 1e-10 * gauss(w, w) / w);
      EXPECT_NEAR(sums.value[n][cg::kBase + 8], phi(z / w) - 1, 1e-10);
    }
  }
}

namespace {

// Everything of one packing at one place of space by the text of the paper: own Gaussian, own images, own quadrature
// of the line integrals (Simpson's rule).
struct BruteForce {
  const cg::StoredSnapshot& s;
  double w;

  double W(const Vec3& r) const {
    return std::exp(-norm2(r) / (2 * w * w)) / std::pow(std::sqrt(2 * std::numbers::pi) * w, 3);
  }

  template <class F>
  void images(F f) const {
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j) f(Vec3{i * s.box.length.x, j * s.box.length.y, 0});
  }

  // integral over s in [0, length] of W(r - from + s r_ij)
  double line(const Vec3& r, const Vec3& from, const Vec3& r_ij, double length) const {
    const int panels = static_cast<int>(std::ceil(norm(r_ij) * length / (0.2 * w)));
    const double h = length / panels;
    double sum = 0;
    images([&](const Vec3& shift) {
      const Vec3 d = r - from - shift;
      for (int k = 0; k <= 2 * panels; ++k) {
        const double weight = k == 0 || k == 2 * panels ? 1 : k % 2 == 1 ? 4 : 2;
        sum += weight * h / 6 * W(d + 0.5 * h * k * r_ij);
      }
    });
    return sum;
  }

  cg::Row at(const Vec3& r) const {
    cg::Row out{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.flowing); ++i) {
      double weight = 0;
      images([&](const Vec3& shift) { weight += W(r - s.x[i] - shift); });
      out[cg::kMass] += s.mass[i] * weight;
      for (std::size_t a = 0; a < 3; ++a) {
        out[cg::kMomentum + a] += s.mass[i] * s.v[i][static_cast<int>(a)] * weight;
        for (std::size_t b = a; b < 3; ++b)
          out[cg::kFlux + cg::symmetric(a, b)] +=
              s.mass[i] * s.v[i][static_cast<int>(a)] * s.v[i][static_cast<int>(b)] * weight;
      }
    }
    for (const dem::Contact& c : s.contacts) {
      const Vec3 x = s.x[static_cast<std::size_t>(c.i)];
      const auto add = [&](std::size_t channel, const Vec3& from, const Vec3& branch, double length) {
        const double mean = line(r, from, branch, length);
        for (std::size_t a = 0; a < 3; ++a)
          for (std::size_t b = 0; b < 3; ++b)
            out[channel + 3 * a + b] -= c.force[static_cast<int>(a)] * branch[static_cast<int>(b)] * mean;
      };
      if (c.j >= 0 && c.j < s.flowing) {
        add(cg::kContact, x, c.branch, 1);
      } else {
        const Vec3 arm = (0.5 * (s.diameter[static_cast<std::size_t>(c.i)] - c.overlap)) * c.normal;
        add(cg::kBase, x, arm, 1);
        add(cg::kBase, x - arm, {0, 0, 1}, 15);  // straight down, far enough
      }
    }
    return out;
  }
};

}  // namespace

TEST(Equation32, ThreeDimensionalFieldsMatchQuadrature) {
  const auto s = test::random_packing(11, 25, 6, 60);
  const double w = 0.35;
  const cg::Grid grid{
      .resolved = {true, true, true}, .count = {3, 3, 4}, .origin = {0.1, 0.2, -0.4}, .spacing = {1.9, 1.7, 2.3}};
  std::vector<cg::Row> sums;
  cg::add_snapshot(sums, grid, laws::CgGaussian{w}, s.view());
  const BruteForce exact{s, w};
  cg::Row peak{}, worst{};
  for (std::int64_t n = 0; n < grid.size(); ++n) {
    const cg::Row expected = exact.at(grid.node(n));
    for (std::size_t c = 0; c < cg::kChannels; ++c) {
      peak[c] = std::max(peak[c], std::abs(expected[c]));
      const bool carries_motion = c <= cg::kMass || (c >= cg::kFlux && c < cg::kVolume);
      if (carries_motion || c >= cg::kContact)
        worst[c] = std::max(worst[c], std::abs(sums[static_cast<std::size_t>(n)][c] - expected[c]));
    }
  }
  for (std::size_t c = 0; c < cg::kChannels; ++c) EXPECT_LE(worst[c], 2e-6 * peak[c]) << "channel " << c;
}

// The stress by the letter of (32), base rays through the base particle to infinity, averaged over x and y: sigma_az agrees wherever
// the base grain is below.
TEST(Equation32, ProfilesAgreeWithRaysToInfinityWhereTheBaseIsBelow) {
  auto s = test::random_packing(12, 40, 10, 80);
  for (dem::Contact& c : s.contacts)
    if (c.j < 0 || c.j >= s.flowing) {
      c.normal = {c.normal.x, c.normal.y, std::abs(c.normal.z) + 0.1};
      c.normal = c.normal / norm(c.normal);
      c.branch = 0.9 * c.normal;
    }
  const laws::CgKernels::Any kernel = laws::CgGaussian{0.3};
  auto moments = cg::make_moments(kernel, cg::make_lattice(kernel, 0.4), s.box);
  cg::ProfileScratch scratch;
  cg::add_snapshot(moments, s.view(), scratch);
  const cg::ProfileSums sums = cg::evaluate(moments, -4, 25);
  for (std::size_t n = 0; n < sums.value.size(); ++n) {
    const double z = moments.lattice.node(-4 + static_cast<std::int64_t>(n));
    Vec3 literal{};
    for (const dem::Contact& c : s.contacts) {
      if (c.j >= 0 && c.j < s.flowing) continue;
      // -f_a r_z times the integral over s of g(z - z_i + s r_z), by Simpson's rule
      const double z_i = s.x[static_cast<std::size_t>(c.i)].z, far = 14 / c.branch.z;
      const int panels = 600;
      double ray = 0;
      for (int k = 0; k <= 2 * panels; ++k)
        ray += (k == 0 || k == 2 * panels ? 1
                : k % 2 == 1              ? 4
                                          : 2) *
               far / (6 * panels) * gauss(z - z_i + 0.5 * far / panels * k * c.branch.z, 0.3);
      literal -= (c.branch.z * ray / 30) * c.force;
    }
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_NEAR(sums.value[n][cg::kBase + 3 * a + 2], literal[static_cast<int>(a)], 1e-8);
  }
}

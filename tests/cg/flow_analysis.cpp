// The flow analysis on fields whose numbers are known, and the regimes on energies made by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cg/flow.hpp"
#include "cg/regime.hpp"
#include "core/error.hpp"
#include "packing.hpp"

using namespace bagnold;

namespace {

constexpr double theta = 24 * std::numbers::pi / 180;
const cg::FlowSetting setting{.gravity = {std::sin(theta), 0, -std::cos(theta)}, .diameter = 1};

// A lithostatic layer of height h on a base at z = 0 with velocity `u` of depth and stress ratio K; all forces are in the base
// channel, whose sum is the same.
template <class U>
cg::MeanProfile layer(double h, double rho, double K, U u, double modulation = 0) {
  cg::MeanProfile p;
  p.samples = 1;
  p.spacing = 0.02;
  p.kernel_width = 0.25;
  for (int n = -100; n * p.spacing < h + 3; ++n) {
    const double z = n * p.spacing;
    const bool inside = z >= 0 && z <= h;
    const double density = inside ? rho * (1 + modulation * std::cos(2 * std::numbers::pi * z / 0.9)) : 0;
    const double weight = rho * std::cos(theta) * std::clamp(h - z, 0.0, h);
    cg::Row q{}, slope{};
    q[cg::kMass] = density;
    q[cg::kVolume] = density * std::numbers::pi / 6;
    q[cg::kMomentum] = density * u(z);
    q[cg::kFlux] = density * u(z) * u(z);
    q[cg::kBase + 0] = -K * weight;
    q[cg::kBase + 2] = std::tan(theta) * weight;
    q[cg::kBase + 8] = -weight;
    if (inside) {
      slope[cg::kBase + 2] = -density * std::sin(theta);
      slope[cg::kBase + 8] = density * std::cos(theta);
    }
    p.z.push_back(z);
    p.value.push_back(q);
    p.slope.push_back(slope);
  }
  p.base_force = rho * h * Vec3{std::sin(theta), 0, -std::cos(theta)};
  return p;
}

double bagnold_u(double z, double h) { return z < 0 ? 0 : z > h ? 2.5 : 2.5 * (1 - std::pow((h - z) / h, 1.5)); }

}  // namespace

TEST(FlowAnalysis, RecoversABagnoldLayer) {
  const double h = 20, rho = 1.07;
  const auto f = cg::analyse(layer(h, rho, 1.06, [&](double z) { return bagnold_u(z, h); }), setting);
  EXPECT_NEAR(*f.base, 0, 1e-9);
  EXPECT_NEAR(*f.surface, h, 1e-9);
  EXPECT_NEAR(*f.h, h, 1e-9);
  EXPECT_NEAR(*f.u_bar, 1.5, 1e-3);   // (3/5) u(h)
  EXPECT_NEAR(*f.alpha, 1.25, 1e-3);  // Bagnold: 5/4
  EXPECT_NEAR(*f.froude, 1.5 / std::sqrt(h * std::cos(theta)), 1e-3);
  EXPECT_NEAR(*f.K, 1.06, 1e-12);
  EXPECT_NEAR(*f.mu_base, std::tan(theta), 1e-12);
  EXPECT_NEAR(*f.mu_cg, std::tan(theta), 1e-12);
  EXPECT_NEAR(*f.phi_bulk, rho * std::numbers::pi / 6, 1e-12);
  EXPECT_NEAR(*f.phi_mean, rho * std::numbers::pi / 6, 1e-3);
  EXPECT_LT(*f.lithostatic_error, 1e-3);
  EXPECT_LT(*f.friction_angle_error_deg, 1e-9);
  EXPECT_LT(*f.residual, 1e-9);
  EXPECT_LT(*f.layering, 0.01);
}

TEST(FlowAnalysis, FindsLayers) {
  const auto f = cg::analyse(layer(
                                 20, 1.0, 1, [](double) { return 1.0; }, 0.2),
                             setting);
  const double k = 2 * std::numbers::pi / 0.9, damping = std::exp(-0.5 * k * k * 0.0625);
  EXPECT_NEAR(*f.layering, 0.1 / damping, 0.02 / damping);  // half the relative amplitude, kernel undone
}

TEST(FlowAnalysis, WhatDoesNotExistIsNothing) {
  const auto thin = cg::analyse(layer(5, 1.0, 1, [](double) { return 1.0; }), setting);
  EXPECT_TRUE(thin.h && thin.u_bar && thin.phi_mean);
  EXPECT_FALSE(thin.phi_bulk || thin.layering);
  const auto at_rest = cg::analyse(layer(20, 1.0, 1, [](double) { return 0.0; }), setting);
  EXPECT_FALSE(at_rest.alpha);
  EXPECT_TRUE(at_rest.u_bar && *at_rest.u_bar == 0);
  const auto empty = cg::analyse({}, setting);
  EXPECT_FALSE(empty.h || empty.mu_base || empty.contacts_per_grain);
}

TEST(FlowAnalysis, IntegratesPiecewiseLinearFunctionsExactly) {
  const std::vector<double> z{0, 1, 3}, f{0, 2, 6};
  EXPECT_DOUBLE_EQ(cg::integrate_nodes(z, f, 0.5, 2.5), 6.0);
  EXPECT_DOUBLE_EQ(cg::integrate_nodes(z, f, -1, 9), 9.0);
}

namespace {

struct Series {
  std::vector<double> t, kinetic, elastic;
  template <class F>
  Series(double end, F ratio) {
    for (int n = 0; n * 0.5 <= end; ++n) {
      t.push_back(n * 0.5);
      // collisional noise of one per cent, as a flow of some thousand grains has
      const double noise = 1 + 0.02 * (random::uniform(1, random::Stream::test, static_cast<std::uint64_t>(n)) - 0.5);
      kinetic.push_back(3 * ratio(n * 0.5) * noise);
      elastic.push_back(3);
    }
  }
  cg::RegimeReport classify(std::optional<double> layering = 0.01) const {
    return cg::classify({t, kinetic, elastic}, layering);
  }
};

}  // namespace

TEST(Regime, FollowsTheStatedCriteria) {
  const Series steady(2000, [](double t) { return 500 * (1 - std::exp(-t / 150)); });
  EXPECT_EQ(steady.classify().regime, cg::Regime::steady);
  EXPECT_EQ(steady.classify(0.4).regime, cg::Regime::layered);
  EXPECT_EQ(steady.classify(std::nullopt).regime, cg::Regime::steady);
  EXPECT_NEAR(*steady.classify().energy_ratio, 500, 1);
  EXPECT_LT(*steady.classify().energy_ratio_err, 1);
  const Series accelerating(2000, [](double t) { return 1e-3 * t * t; });
  EXPECT_EQ(accelerating.classify().regime, cg::Regime::accelerating);
  EXPECT_NEAR(*accelerating.classify().growth, 2, 0.01);
  const Series oscillating(2000, [](double t) { return 100 * (1 + 0.5 * std::sin(t / 9) * std::sin(t / 23)); });
  EXPECT_EQ(oscillating.classify().regime, cg::Regime::oscillating);
  const Series arrested(400, [](double t) { return t < 60 ? 20 * std::exp(-t / 3) : 1e-9; });
  EXPECT_EQ(arrested.classify().regime, cg::Regime::arrested);
  const Series slowing(400, [](double t) { return 100 * std::exp(-t / 100); });
  EXPECT_EQ(slowing.classify().regime, std::nullopt);  // neither: it has not stopped yet
}

namespace {

double normal(std::uint64_t seed, std::uint64_t n) {
  const double u = 1 - random::uniform(seed, random::Stream::test, 2 * n),
               v = random::uniform(seed, random::Stream::test, 2 * n + 1);
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

// How many of `seeds` flows with R = mean(t) (1 + noise) are found to be of some regime, nothing included; the noise has the standard
// deviation `size` and is forgotten within `memory`, like the slow modes of a flow.
template <class F>
int count(std::optional<cg::Regime> regime, double end, double size, double memory, F mean, int seeds = 200) {
  int found = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto of = static_cast<std::uint64_t>(seed);
    double noise = normal(of, 0);
    std::vector<double> t, kinetic;
    const double kept = std::exp(-0.5 / memory);
    for (int n = 0; 0.5 * n <= end; ++n) {
      t.push_back(0.5 * n);
      kinetic.push_back(mean(0.5 * n) * (1 + size * noise));
      noise = kept * noise + std::sqrt(1 - kept * kept) * normal(of, static_cast<std::uint64_t>(n) + 1);
    }
    found += cg::classify({t, kinetic, std::vector<double>(t.size(), 1.0)}, 0.01).regime == regime ? 1 : 0;
  }
  return found;
}

}  // namespace

// The flow of cases/demo.toml wanders by 5 % and forgets within 15 to 20 time units; twice that, and runs of any length.
TEST(Regime, SlowModesAreNotAcceleration) {
  const auto balance = [](double) { return 500.0; };
  const auto approach = [](double t) { return 500 * std::pow(1 - std::exp(-t / 30), 2); };
  for (double end : {100.0, 150.0, 300.0, 2000.0}) {
    EXPECT_GE(count(cg::Regime::steady, end, 0.05, 20, balance), 198) << end;
    EXPECT_GE(count(cg::Regime::steady, end, 0.05, 50, balance), 190) << end;
  }
  EXPECT_GE(count(cg::Regime::steady, 150, 0.05, 20, approach), 190);
  EXPECT_GE(count(cg::Regime::oscillating, 2000, 0.2, 50, balance), 190);
}

TEST(Regime, AccelerationIsFoundUnderSlowModes) {
  for (double end : {100.0, 150.0, 300.0, 2000.0}) {
    EXPECT_GE(count(cg::Regime::accelerating, end, 0.05, 20, [](double t) { return t * t; }), 198) << end;
    // half the acceleration goes on after a fast start
    EXPECT_GE(count(cg::Regime::accelerating, end, 0.05, 20, [&](double t) { return std::pow(0.5 * end + t, 2); }), 198)
        << end;
  }
  // a flow that speeds up like t^(1/2): R grows like t
  EXPECT_GE(count(cg::Regime::accelerating, 2000, 0.05, 20, [](double t) { return t; }), 198);
  EXPECT_GE(count(std::nullopt, 400, 0.05, 20, [](double t) { return std::exp(-t / 100); }), 198);
}

TEST(Regime, NeedsSamples) {
  const std::vector<double> none, one{1};
  EXPECT_FALSE(cg::classify({none, none, none}, {}).regime);
  EXPECT_FALSE(cg::classify({one, one, one}, {}).energy_ratio);
  // The grains hover during the first fall: no arrest before t = 10.
  const std::vector<double> t{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, still(10, 0.0), elastic(10, 1.0);
  EXPECT_NE(cg::classify({t, still, elastic}, {}).regime, cg::Regime::arrested);
}

namespace {

cg::StoredSnapshot instant(std::uint64_t k) {
  auto s = test::random_packing(100 + k);
  s.time = 0.5 * static_cast<double>(k);
  return s;
}

double largest_difference(const cg::MeanProfile& a, const cg::MeanProfile& b) {
  double worst = 0;
  for (std::size_t n = 0; n < a.z.size(); ++n)
    for (std::size_t m = 0; m < b.z.size(); ++m)
      if (std::abs(a.z[n] - b.z[m]) < 1e-9)
        for (std::size_t c = 0; c < cg::kChannels; ++c)
          worst = std::max({worst, std::abs(a.value[n][c] - b.value[m][c]), std::abs(a.slope[n][c] - b.slope[m][c])});
  return worst;
}

}  // namespace

// However the samples fall into blocks, and however blocks have merged, the average is the average.
TEST(Blocks, HoldTheAverageThroughMergesAndGrowth) {
  const laws::CgKernels::Any kernel = laws::CgGaussian{0.3};
  auto moments = cg::make_moments(kernel, cg::make_lattice(kernel, 0.1), instant(0).box);
  cg::ProfileScratch scratch;
  cg::BlockedProfile merged(kernel, 0.1, instant(0).box), planned(kernel, 0.1, instant(0).box, 150);
  for (std::uint64_t k = 0; k < 150; ++k) {
    auto s = instant(k % 7);
    s.time = 0.5 * static_cast<double>(k);
    if (k == 40) s.x[3].z = 21;  // the profile grows on the way
    cg::add_snapshot(moments, s.view(), scratch);
    merged.add(s.view());
    planned.add(s.view());
  }
  const auto mean = merged.mean();
  EXPECT_EQ(mean.samples, 150);
  EXPECT_EQ(mean.begin, 0);
  EXPECT_EQ(mean.end, 74.5);
  EXPECT_LT(merged.complete_blocks(), cg::BlockedProfile::most_blocks);
  const auto plain = cg::evaluate(moments, std::llround(mean.z[0] / 0.1), static_cast<std::int64_t>(mean.z.size()));
  for (std::size_t n = 0; n < mean.z.size(); ++n)
    for (std::size_t c = 0; c < cg::kChannels; ++c) EXPECT_NEAR(mean.value[n][c], plain.value[n][c] / 150, 1e-12);
  EXPECT_LT(largest_difference(mean, planned.mean()), 1e-12);
  const auto from_blocks = planned.mean(0, planned.complete_blocks());
  EXPECT_LT(largest_difference(mean, from_blocks), 1e-11);
  EXPECT_EQ(planned.complete_blocks(), 50);
}

TEST(Blocks, OtherWidthsComeFromTheSameSums) {
  const laws::CgKernels::Any wide = laws::CgGaussian{0.3}, narrow = laws::CgGaussian{0.1};
  cg::BlockedProfile a(wide, 0.1, instant(0).box), b(narrow, 0.1, instant(0).box);
  a.add(instant(1).view());
  b.add(instant(1).view());
  EXPECT_LT(largest_difference(a.mean_with_width(0.1), b.mean()), 1e-6);
  EXPECT_THROW(a.mean_with_width(0.01), UnphysicalError);
}

TEST(Blocks, StateIsExact) {
  const laws::CgKernels::Any kernel = laws::CgGaussian{0.3};
  cg::BlockedProfile whole(kernel, 0.1, instant(0).box, 20), first(kernel, 0.1, instant(0).box, 20),
      second(kernel, 0.1, instant(0).box, 20);
  for (std::uint64_t k = 0; k < 20; ++k) whole.add(instant(k).view());
  for (std::uint64_t k = 0; k < 9; ++k) first.add(instant(k).view());
  const auto from = first.state("cg/"), to = second.state("cg/");
  ASSERT_EQ(from.size(), to.size());
  for (std::size_t k = 0; k < from.size(); ++k)
    std::visit([&](auto* source) { *std::get<decltype(source)>(to[k].array) = *source; }, from[k].array);
  for (std::uint64_t k = 9; k < 20; ++k) second.add(instant(k).view());
  EXPECT_EQ(largest_difference(whole.mean(), second.mean()), 0);
  EXPECT_EQ(whole.mean().z, second.mean().z);
}

// Independent samples: the jackknife of a plain average is its standard error.
TEST(Blocks, ErrorsAreThoseOfIndependentSamples) {
  const laws::CgKernels::Any kernel = laws::CgGaussian{0.3};
  const int n = 256;
  cg::BlockedProfile blocks(kernel, 0.1, instant(0).box, n);
  double sum = 0, square = 0;
  for (int k = 0; k < n; ++k) {
    auto s = instant(static_cast<std::uint64_t>(k));
    const auto keep =
        static_cast<std::size_t>(200 + 100 * random::uniform(9, random::Stream::test, static_cast<std::uint64_t>(k)));
    s.contacts.resize(keep);
    blocks.add(s.view());
    const double per_grain = static_cast<double>(keep) / 120;
    sum += per_grain;
    square += per_grain * per_grain;
  }
  const double variance = (square - sum * sum / n) / (n - 1);
  const auto e = cg::errors(blocks, setting);
  ASSERT_TRUE(e.contacts_per_grain);
  EXPECT_NEAR(*e.contacts_per_grain, std::sqrt(variance / n), 0.5 * std::sqrt(variance / n));
  EXPECT_NEAR(*cg::analyse(blocks.mean(), setting).contacts_per_grain, sum / n, 1e-9);
}

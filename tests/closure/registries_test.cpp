// What every friction law and every closure must do, over the registries: a new law is tested before its author writes a
// test. Numbers and packs of numbers must agree.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/simd.hpp"
#include "laws/registries.hpp"

namespace bagnold::laws {
namespace {

const std::vector<double> thicknesses = {1e-6, 0.1, 1, 3, 10, 40, 1000};
const std::vector<double> froudes = {0, 1e-6, 0.05, 0.2, 0.6, 1, 3, 30};

template <class Law>
void expect_sound_fields() {
  const Law law;
  for_each_field<Law>([&](const auto& f) {
    EXPECT_FALSE(f.unit.empty()) << Law::name << ' ' << f.name;
    EXPECT_FALSE(f.meaning.empty()) << Law::name << ' ' << f.name;
    EXPECT_TRUE(f.range.contains(static_cast<double>(law.*(f.member)))) << Law::name << ' ' << f.name;
    EXPECT_FALSE(f.range.contains(std::nan(""))) << Law::name << ' ' << f.name;
  });
  EXPECT_FALSE(Law::summary.empty());
  EXPECT_FALSE(Law::source.empty());
}

// f(law, its name, law with its tangents taken) for every friction law.
template <class F>
void for_each_friction(F&& f) {
  FrictionLaws::for_each([&](const auto& law) { f(law, std::string(law.name), law.prepared(9.81)); });
}

}  // namespace

TEST(FrictionLaws, DescribeThemselves) {
  FrictionLaws::for_each([](const auto& law) { expect_sound_fields<std::decay_t<decltype(law)>>(); });
  expect_sound_fields<StaticBranch>();
}

TEST(FrictionLaws, AreFinitePositiveAndNotDecreasingInTheFroudeNumber) {
  for_each_friction([](const auto&, const std::string& name, const auto& law) {
    for (const double h : thicknesses) {
      double last = 0;
      for (const double F : froudes) {
        const double mu = law.mu(h, F);
        EXPECT_TRUE(std::isfinite(mu)) << name;
        EXPECT_GT(mu, 0) << name;
        EXPECT_GE(mu, last * (1 - 1e-14)) << name << ' ' << h << ' ' << F;
        last = mu;
      }
    }
  });
}

TEST(FrictionLaws, DoNotGrowWithThickness) {
  for_each_friction([](const auto&, const std::string& name, const auto& law) {
    for (const double F : froudes)
      for (std::size_t k = 1; k < thicknesses.size(); ++k)
        EXPECT_LE(law.mu(thicknesses[k], F), law.mu(thicknesses[k - 1], F) * (1 + 1e-14)) << name << ' ' << F;
  });
}

TEST(FrictionLaws, SlopeIsTheDerivative) {
  for_each_friction([](const auto&, const std::string& name, const auto& law) {
    for (const double h : {1.0, 10.0, 40.0})
      for (const double F : {0.2, 0.6, 1.0, 3.0}) {
        const double e = 1e-5, numeric = (law.mu(h, F + e) - law.mu(h, F - e)) / (2 * e);
        const MuAndSlope m = law.mu_and_slope(h, F);
        EXPECT_NEAR(m.mu, law.mu(h, F), 1e-15) << name;
        EXPECT_NEAR(m.slope, numeric, 1e-9 + 1e-7 * std::abs(numeric)) << name << ' ' << h << ' ' << F;
      }
  });
}

TEST(FrictionLaws, PacksAgreeWithNumbers) {
  for_each_friction([](const auto&, const std::string& name, const auto& law) {
    const BasalFriction full(law, StaticBranch{.froude_star = 0.15, .kappa = 0.5});
    for (const double h : thicknesses) {
      Pack F = 0.0;
      for (int k = 0; k < Pack::lanes; ++k) F.set(k, froudes[static_cast<std::size_t>(k)]);
      const MuAndSlopeOf<Pack> m = law.mu_and_slope(Pack(h), F),
                               s = full.mu_and_slope(Pack(h), F, full.mu_start(Pack(h)));
      for (int k = 0; k < Pack::lanes; ++k) {
        const MuAndSlope one = law.mu_and_slope(h, F[k]), whole = full.mu_and_slope(h, F[k], full.mu_start(h));
        EXPECT_NEAR(m.mu[k], one.mu, 1e-14 * one.mu) << name;
        EXPECT_NEAR(m.slope[k], one.slope, 1e-13 * std::abs(one.slope)) << name;
        EXPECT_NEAR(s.mu[k], whole.mu, 1e-14 * whole.mu) << name;
        EXPECT_NEAR(s.slope[k], whole.slope, 1e-13 * std::abs(whole.slope)) << name;
      }
    }
  });
}

// Thickness in grain diameters is all that counts: rescaling lengths by 16 changes nothing.
TEST(FrictionLaws, DependOnThicknessOverDiameter) {
  for_each_friction([](auto law, const std::string& name, const auto& prepared) {
    if constexpr (requires { law.d; }) {
      law.d *= 16;
      EXPECT_EQ(law.prepared(9.81).mu(160.0, 0.7), prepared.mu(10.0, 0.7)) << name;
    } else {
      EXPECT_EQ(prepared.mu(160.0, 0.7), prepared.mu(10.0, 0.7)) << name;
    }
  });
}

TEST(FrictionLaws, Limits) {
  const PouliquenForterre rational;
  const auto p = rational.prepared(1);
  EXPECT_NEAR(p.mu(10.0, 1e12), tan_deg(rational.delta2_deg), 1e-10);
  EXPECT_NEAR(p.mu(1e-12, 0.5), tan_deg(rational.delta2_deg), 1e-10);
  EXPECT_NEAR(p.mu(1e12, 0.5), tan_deg(rational.delta1_deg), 1e-10);
  PouliquenForterre smooth;  // gamma < 0: no pole, delta1 below it
  smooth.gamma = -0.2;
  EXPECT_EQ(smooth.prepared(1).mu(10.0, 0.1), tan_deg(smooth.delta1_deg));
  const ExponentialFriction exponential;
  EXPECT_NEAR(exponential.prepared(1).mu(10.0, 1e12), tan_deg(exponential.delta2_deg), 1e-10);
  EXPECT_NEAR(exponential.prepared(1).mu(1e12, 0.5), tan_deg(exponential.delta1_deg), 1e-10);
  const Jenkins jenkins;
  EXPECT_NEAR(jenkins.prepared(1).mu(10.0, 1e9), tan_deg(jenkins.delta2_deg), 1e-8);
  EXPECT_NEAR(jenkins.prepared(1).mu(1e9, 0.5), tan_deg(jenkins.delta1_deg), 1e-8);
  const MuOfI mu_of_i;
  EXPECT_EQ(mu_of_i.prepared(1).mu(10.0, 0.0), mu_of_i.mu_s);
  EXPECT_NEAR(mu_of_i.prepared(1).mu(10.0, 1e12), mu_of_i.mu_2, 1e-10);
  PouliquenForterre one_angle;  // delta1 -> delta2 is Coulomb's law
  one_angle.delta2_deg = one_angle.delta1_deg;
  EXPECT_EQ(one_angle.prepared(1).mu(3.0, 0.4), Coulomb{one_angle.delta1_deg}.prepared(1).mu(3.0, 0.4));
}

// Eqs 38-40: steady uniform flow at theta is where the law gives tan(theta).
TEST(FrictionLaws, ReproduceTheFlowRulesTheyComeFrom) {
  for (const double theta : {21.0, 24.0, 28.0}) {
    const double t = tan_deg(theta), h = 12;
    const ExponentialFriction e;
    const double h_stop =
        -e.A * e.d * std::log((t - tan_deg(e.delta1_deg)) / (tan_deg(e.delta2_deg) - tan_deg(e.delta1_deg)));
    EXPECT_NEAR(e.prepared(1).mu(h, e.beta * h / h_stop - e.gamma), t, 1e-12);
    const Jenkins j;
    const double t1 = tan_deg(j.delta1_deg), stop = j.A * j.d * (tan_deg(j.delta2_deg) - t) / (t - t1);
    EXPECT_NEAR(j.prepared(1).mu(h, j.beta * h / stop * t * t / (t1 * t1) - j.gamma), t, 1e-12);
    const MuOfI m;
    const double I = m.I0 / ((m.mu_2 - m.mu_s) / (t - m.mu_s) - 1);
    if (I > 0) {
      EXPECT_NEAR(m.prepared(1).mu(h, I * h * std::sqrt(m.phi) / (2.5 * m.d)), t, 1e-12);
    }
  }
  const Voellmy v{.mu0 = 0.2, .xi = 500};  // mu0 + u^2/(xi h cos(theta)) with F^2 = u^2/(g h cos(theta))
  const double u = 20, h = 2, c = 0.9, g = 9.81;
  EXPECT_NEAR(v.prepared(g).mu(h, u / std::sqrt(g * h * c)), 0.2 + u * u / (500 * h * c), 1e-14);
}

TEST(StaticBranch, JoinsTheDynamicLawAndHoldsALayerAtRest) {
  const auto law = PouliquenForterre{}.prepared(1);
  for (const double kappa : {1.0, 0.5, 1e-3}) {
    const StaticBranch branch{.froude_star = 0.156, .kappa = kappa};
    const BasalFriction f(law, branch);
    EXPECT_NEAR(f.mu_start(1e12), tan_deg(branch.delta3_deg), 1e-10);
    EXPECT_NEAR(f.mu_start(0.0), tan_deg(branch.delta3_deg) + tan_deg(branch.delta2_deg) - tan_deg(branch.delta1_deg),
                1e-14);
    for (const double h : {2.0, 10.0}) {
      EXPECT_EQ(f.mu(h, 0.0), f.mu_start(h));
      EXPECT_NEAR(f.mu(h, 0.156 * (1 - 1e-12)), law.mu(h, 0.156), 1e-10);
      EXPECT_EQ(f.mu(h, 0.3), law.mu(h, 0.3));
      EXPECT_NEAR(f.mu(h, 0.078), f.mu_start(h) + std::pow(0.5, kappa) * (law.mu(h, 0.156) - f.mu_start(h)), 1e-14);
    }
  }
  const BasalFriction off(law, StaticBranch{});  // F* = 0: the dynamic law down to rest
  EXPECT_EQ(off.mu_start(5.0), law.mu(5.0, 0.0));
  EXPECT_EQ(off.mu(5.0, 0.01), law.mu(5.0, 0.01));
}

TEST(ClosureLaws, DescribeThemselvesAndStayInTheirRange) {
  DensityLaws::for_each([](const auto& law) {
    expect_sound_fields<std::decay_t<decltype(law)>>();
    for (double theta = 18; theta <= 29; theta += 1) {
      EXPECT_GT(law.volume_fraction(theta), 0.4) << law.name;
      EXPECT_LT(law.volume_fraction(theta), 0.74) << law.name;
      EXPECT_GE(law.volume_fraction(theta), law.volume_fraction(theta + 0.5)) << law.name;
    }
  });
  StressRatioLaws::for_each([](const auto& law) {
    expect_sound_fields<std::decay_t<decltype(law)>>();
    for (double theta = 18; theta <= 29; theta += 1) {
      EXPECT_GT(law.ratio(theta), 0.9) << law.name;
      EXPECT_LT(law.ratio(theta), 1.1) << law.name;
    }
  });
  ShapeFactorLaws::for_each([](const auto& law) {
    expect_sound_fields<std::decay_t<decltype(law)>>();
    for (const double h : thicknesses)
      for (double theta = 18; theta <= 32; theta += 1) {
        const double alpha = law.factor(h, tan_deg(theta));
        EXPECT_GE(alpha, 1) << law.name << ' ' << h << ' ' << theta;  // mean(u^2) >= mean(u)^2
        EXPECT_LT(alpha, 2) << law.name << ' ' << h << ' ' << theta;
      }
  });
}

}  // namespace bagnold::laws

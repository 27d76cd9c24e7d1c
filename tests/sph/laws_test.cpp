#include <algorithm>
#include <complex>

#include "helpers.hpp"

namespace bagnold::laws {
namespace {

TEST(Pack, ExponentialHasFullPrecisionAndSameBitsInEveryLane) {
  for (double x = 0; x < 600; x += 0.37) {
    const double e = exp_negative(-x);
    EXPECT_NEAR(e / std::exp(-x), 1, 1e-14) << x;
    EXPECT_EQ(exp_negative(Pack(-x))[3], e);
  }
  for (double x = 1e-12; x < 50; x *= 1.7) EXPECT_NEAR(one_minus_exp_over(x) / (-std::expm1(-x) / x), 1, 1e-12) << x;
}

TEST(Kernel, IntegratesToOneAndSlopeIsItsDerivative) {
  SphKernels::for_each([](const auto& kernel) {
    using K = std::decay_t<decltype(kernel)>;
    for (const int dim : {2, 3}) {
      double integral = 0;
      const double dR = 1e-4;
      for (double R = 0.5 * dR; R < 2; R += dR)
        integral += K::norm(dim) * K::value(R) * (dim == 2 ? 2 * M_PI * R : 4 * M_PI * R * R) * dR;
      EXPECT_NEAR(integral, 1, 1e-6) << K::name;
    }
    for (double R = 0.05; R < 2.2; R += 0.1)
      EXPECT_NEAR(K::slope(K::slope_norm, R) * R, -(K::value(R + 1e-6) - K::value(R - 1e-6)) / 2e-6, 1e-6) << K::name;
  });
}

TEST(Rheology, StartsAtStaticFrictionAndRises) {
  Rheologies::for_each([](const auto& law) {
    EXPECT_DOUBLE_EQ(law.mu(0), law.static_friction());
    double last = law.mu(0);
    for (double i = 1e-3; i < 100; i *= 1.3) {
      EXPECT_GT(law.mu(i), last);
      last = law.mu(i);
    }
  });
  EXPECT_NEAR(rheology::MuI{}.mu(1e9), rheology::MuI{}.limit_friction(), 1e-8);
  EXPECT_NEAR(rheology::MuICollisional{}.mu(1e-3), rheology::MuI{}.mu(1e-3), 1e-7);
}

// The collisional branch leaves the dense law alone where that is known, up to i = 0.3, and takes over beyond.
TEST(Rheology, CollisionalBranchJoinsTheDenseLaw) {
  const rheology::MuI dense;
  const rheology::MuICollisional both;
  const auto excess = both.excess();
  for (double i = 1e-4; i <= 0.3; i *= 1.2) EXPECT_NEAR(both.mu(i) / dense.mu(i), 1, 3e-3) << i;
  for (double i = 0.29; i < 0.31; i += 1e-3)  // no corner at 0.3
    EXPECT_NEAR(both.mu(i + 1e-3) - 2 * both.mu(i) + both.mu(i - 1e-3), 0, 1e-6);
  EXPECT_NEAR((both.mu(2e6) - both.mu(1e6)) / 1e6, both.mu_inf, 1e-6);
  EXPECT_NEAR(excess(0.0), dense.excess()(0.0), 1e-15);
  const rheology::MuICollisional none{.mu_inf = 0};
  for (double i = 1e-4; i < 1e3; i *= 2) EXPECT_DOUBLE_EQ(none.mu(i), dense.mu(i));
}

TEST(Dilatancy, CollisionalBranchJoinsTheDenseLawAndStaysPositive) {
  const dilatancy::Linear dense;
  const dilatancy::Rational both;
  double last = both.phi(0);
  EXPECT_DOUBLE_EQ(last, dense.phi(0));
  for (double i = 1e-4; i < 1e4; i *= 1.2) {
    EXPECT_LT(both.phi(i), last);
    EXPECT_GT(both.phi(i), 0);
    if (i <= 0.3) EXPECT_NEAR(both.phi(i) / dense.phi(i), 1, 3e-3) << i;
    last = both.phi(i);
  }
  // dilute and hard: Bagnold's p ~ (rho d gamma)^2
  const auto p = [&](double r, double shear) { return std::pow(eos::largest_root(both.cubic(r, shear), 0.1), 2); };
  EXPECT_NEAR(p(0.5, 2e-4) / p(0.5, 1e-4), 4, 1e-3);
}

// rho* = phi(i) rho_s*, i = shear/y: what the cubic was derived from.
TEST(Cubic, RootSatisfiesTheLawsItCameFrom) {
  Dilatancies::for_each([](const auto& law) {
    for (double r = 0.3; r < 1.4; r += 0.01)
      for (double shear = 1e-9; shear < 10; shear *= 3)
        for (const double guess : {0.0, 1e-3, 0.5, 1e3}) {
          const double y = eos::largest_root(law.cubic(r, shear), guess);
          ASSERT_GT(y, 0);
          const double rho = law.phi(shear / y) * (1 + y * y) / law.phi_max;
          // the linear law loses digits where phi crosses zero; compare the cubic's own residual there
          ASSERT_NEAR(rho, r, 1e-9 * (1 + shear / y + y * y)) << law.name << " shear " << shear;
        }
  });
}

TEST(Cubic, IsTheLargestRootOfEquation44) {
  const dilatancy::Linear phi;
  for (double r = 0.8; r < 1.1; r += 0.013)
    for (double shear = 1e-4; shear < 1; shear *= 4) {
      const double y = eos::largest_root(phi.cubic(r, shear), 0.0), q = 1 + y * y, rs = r * phi.phi_max;
      const double A = shear * shear * 0.1 * 0.1 / (0.6 * 0.6);
      const auto printed = [&](double s) {
        return s * s * s - (1 + 2 * rs / 0.6 + A) * s * s + rs * (rs + 1.2) / 0.36 * s - rs * rs / 0.36;
      };
      EXPECT_NEAR(printed(q), 0, 1e-10 * q * q * q);
      for (double s = q * (1 + 1e-6); s < 3 * q; s *= 1.01) ASSERT_GT(printed(s), 0);  // nothing larger
    }
}

TEST(Cubic, AtRestIsElasticOrUnloaded) {
  const dilatancy::Linear phi;
  for (const double r : {0.2, 0.9, 0.999999}) EXPECT_LT(eos::largest_root(phi.cubic(r, 0.0), 0.3), 1e-7);
  for (const double r : {1.000001, 1.01, 1.5})
    EXPECT_NEAR(eos::largest_root(phi.cubic(r, 0.0), 0.3), std::sqrt(r - 1), 1e-9);
}

TEST(Regularisation, ViscosityIsFinitePositiveFallsWithShearAndTendsToTheLaw) {
  Regularisations::for_each([](auto law) {
    for (double tau = 1e-6; tau < 3000; tau *= 4) {  // below tau0/4 the clipped m_p of minatti2015 is not monotone
      double last = 1e300;
      for (double gamma = 1e-12; gamma < 1e4; gamma *= 2) {
        const double eta = law.viscosity(tau, 0.01 * std::sqrt(tau), gamma);
        ASSERT_TRUE(std::isfinite(eta) && eta >= 0) << law.name << ' ' << tau << ' ' << gamma;
        if (tau > 200) {
          ASSERT_LE(eta, last * (1 + 1e-12));
        }
        last = eta;
      }
    }
    EXPECT_NEAR(law.viscosity(500.0, 0.1, 1e4) / (0.1 + 500 / 1e4), 1, 1e-3) << law.name;
  });
}

TEST(Regularisation, MatchesThePrintedFormWithItsLogarithm) {
  const regularisation::Minatti2015 law{795, 1.2};
  for (double tau = 200; tau < 1500; tau *= 1.3)
    for (double gamma = 1e-2; gamma < 30; gamma *= 2) {
      const double eta0 = 3;
      const double mp = 1.2 + std::log(1 + eta0 * gamma * (tau - 795) / (795 * (tau + eta0 * gamma))) / gamma;
      EXPECT_NEAR(law.viscosity(tau, eta0, gamma) / (eta0 + tau * (1 - std::exp(-mp * gamma)) / gamma), 1, 1e-12);
    }
  // largest viscosities of table 3: eta0(tau0, 0) + tau0 m0
  EXPECT_NEAR(law.viscosity(795.0, 0.0, 0.0), 954, 1e-9);
}

TEST(Mean, LiesBetweenAndIsSymmetric) {
  ViscosityMeans::for_each([](const auto& mean) {
    using M = std::decay_t<decltype(mean)>;
    const auto of = [](double a, double b) { return M::over(1.0, a, b); };
    EXPECT_DOUBLE_EQ(of(3, 3), 3);
    EXPECT_DOUBLE_EQ(of(1, 9), of(9, 1));
    EXPECT_GE(of(1, 9), 1);
    EXPECT_LE(of(1, 9), 9);
    EXPECT_EQ(of(0, 0), 0);
    EXPECT_DOUBLE_EQ(M::over(5.0, 1.0, 9.0), of(1, 9) / 5);
  });
}

}  // namespace
}  // namespace bagnold::laws

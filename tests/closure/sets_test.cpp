// The closure sets that ship with the program against the numbers and equations of Weinhart et al. 2012.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "closure/closure_set.hpp"

namespace bagnold::closure {
namespace {

using laws::tan_deg;

ClosureSet set_of(const char* lambda, double d = 1) {
  const auto set = builtin(std::string("weinhart2012/") + lambda, d, 6 / std::numbers::pi);
  EXPECT_TRUE(set) << lambda;
  return *set;
}

// alpha = h int u^2 dz/(int u dz)^2 of a profile given by its strain, u(0) = slip, by the midpoint rule; z in units of h.
double shape_of(const std::function<double(double)>& strain, double slip = 0) {
  constexpr int n = 200000;
  double u = slip, mean = 0, square = 0;
  for (int k = 0; k < n; ++k) {
    const double step = strain((k + 0.5) / n) / n, middle = u + 0.5 * step;
    mean += middle / n;
    square += middle * middle / n;
    u += step;
  }
  return square / (mean * mean);
}

TEST(Sets, AreNamedAndUnknownNamesAreNotInvented) {
  EXPECT_EQ(builtin_names().size(), 6u);
  for (const std::string& name : builtin_names()) {
    const auto set = builtin(name, 1, 1);
    ASSERT_TRUE(set);
    EXPECT_EQ(set->name, name);
    EXPECT_NE(describe(*set).find("Weinhart"), std::string::npos);
  }
  EXPECT_FALSE(builtin("weinhart2012/3", 1, 1));
  EXPECT_FALSE(builtin("", 1, 1));
}

// Eqs 47, 50: every base uses the stopping height of lambda = 1 with its own beta and gamma; table 1.
TEST(Sets, FlowRulesOfTableOne) {
  struct Row {
    const char* lambda;
    double beta, gamma, error;
  };
  for (const Row& row :
       {Row{"0", 1.5, -4.065, 0.886}, Row{"1/2", 0.300, -0.236, 0.229}, Row{"2/3", 0.215, -0.143, 0.104},
        Row{"5/6", 0.203, 0.039, 0.113}, Row{"1", 0.196, 0.040, 0.121}, Row{"2", 0.189, 0.080, 0.137}}) {
    const ClosureSet set = set_of(row.lambda);
    const auto& law = std::get<laws::PouliquenForterre>(set.friction);
    EXPECT_EQ(law.beta, row.beta);
    EXPECT_EQ(law.gamma, row.gamma);
    EXPECT_EQ(law.delta1_deg, 17.708);
    EXPECT_EQ(law.delta2_deg, 32.780);
    EXPECT_EQ(law.A, 3.355);
    EXPECT_EQ(set.flow_rule_error, row.error);
    // steady uniform flow: F = beta h/h_stop(theta) - gamma is where mu = tan(theta)
    for (const double theta : {22.0, 24.0, 26.0, 28.0})
      for (const double h : {12.0, 20.0, 40.0}) {
        const double F = row.beta * h / laws::stopping_height(law, theta) - row.gamma;
        if (F > 0) {
          EXPECT_NEAR(law.prepared(1).mu(h, F), tan_deg(theta), 1e-12) << row.lambda << ' ' << theta;
        }
      }
  }
}

// Eqs 46, 48: the range of steady flow.
TEST(Sets, ValidityRanges) {
  for (const char* lambda : {"1/2", "2/3", "5/6", "1", "2"})
    EXPECT_EQ(set_of(lambda).validity.theta_hi_deg, 29) << lambda;
  EXPECT_EQ(set_of("1").validity.theta_lo_deg, 17.708);
  for (const std::string& name : builtin_names()) {
    const Validity v = builtin(name, 1, 1)->validity;
    EXPECT_LT(v.theta_lo_deg, v.theta_hi_deg) << name;
  }
}

TEST(Sets, DensityAndStressRatio) {  // eqs 52, 53
  const laws::ExponentialAngleDensity density;
  EXPECT_NEAR(density.volume_fraction(24), 0.569, 5e-4);
  EXPECT_NEAR(density.volume_fraction(29), 0.514, 5e-4);
  const laws::LinearAngleStressRatio ratio;
  EXPECT_EQ(ratio.ratio(21.5), 1);
  EXPECT_NEAR(ratio.ratio(29) - ratio.ratio(24), 5.0 / 132, 1e-14);
  for (double theta = 18; theta < 29; theta += 0.5) {
    EXPECT_GT(density.volume_fraction(theta), density.volume_fraction(theta + 0.5));
    EXPECT_GT(ratio.ratio(theta), 0.97);  // the range the paper states: 0.98 ... 1.07
    EXPECT_LT(ratio.ratio(theta), 1.07);
  }
}

// Eq. 54 in closed form against its own strain, integrated numerically.
TEST(Sets, ShapeFactorOfTheStrainModelAgainstQuadrature) {
  for (const char* lambda : {"5/6", "1", "2"}) {
    const ClosureSet set = set_of(lambda);
    const auto& model = std::get<laws::StrainModelShapeFactor>(set.shape_factor);
    const auto& law = std::get<laws::PouliquenForterre>(set.friction);
    for (const double theta : {20.0, 24.0, 28.0})
      for (const double h : {6.0, 10.0, 20.0, 40.0}) {
        const double b = std::min(1.0, model.base_layer * laws::stopping_height(law, theta) / (h * h));
        const double top = std::max(1 - 5 / h, b);
        const auto bagnold = [](double z) { return std::sqrt(1 - z); };
        const double alpha = shape_of(
            [&](double z) { return z < b ? bagnold(b) * (1 - 2.0 / 3 * (b - z) / b) : bagnold(std::min(z, top)); });
        if (b < 0.999) {
          EXPECT_NEAR(model.factor(h, tan_deg(theta)), alpha, 1e-6) << lambda << ' ' << theta << ' ' << h;
        }
        EXPECT_GE(model.factor(h, tan_deg(theta)), 1);
      }
  }
  const auto model = std::get<laws::StrainModelShapeFactor>(set_of("1").shape_factor);
  EXPECT_NEAR(model.factor(10, tan_deg(24)), 1.435, 5e-4);
  EXPECT_NEAR(model.factor(40, tan_deg(24)), 1.260, 5e-4);
  EXPECT_NEAR(model.factor(1e5, tan_deg(24)), 1.25, 1e-3);  // Bagnold's profile
}

// Eq. 55, with the bracket that has mean 1: the constant factors of the smoother bases, table 2.
TEST(Sets, ShapeFactorsOfSmootherBases) {
  const auto factor = [](const char* lambda) {
    return std::get<laws::ConstantShapeFactor>(set_of(lambda).shape_factor).alpha;
  };
  const auto parabola = [](double z) { return 3 * (1 - z); };  // derivative of (3/2)(1 - (1 - z)^2)
  EXPECT_NEAR(factor("2/3"), shape_of(parabola), 1.5e-3);
  EXPECT_NEAR(factor("1/2"), shape_of([&](double z) { return 0.84 * parabola(z); }, 0.16), 1.5e-3);
  EXPECT_EQ(factor("0"), 1);
}

// Lengths scale with the diameter, densities with that of the grains.
TEST(Sets, Units) {
  const ClosureSet one = set_of("1"), large = set_of("1", 16);
  const auto &a = std::get<laws::PouliquenForterre>(one.friction),
             &b = std::get<laws::PouliquenForterre>(large.friction);
  EXPECT_EQ(a.prepared(1).mu(10.0, 0.7), b.prepared(1).mu(160.0, 0.7));
  EXPECT_EQ(std::get<laws::StrainModelShapeFactor>(one.shape_factor).factor(10, 0.45),
            std::get<laws::StrainModelShapeFactor>(large.shape_factor).factor(160, 0.45));
  EXPECT_EQ(large.static_branch.length, 16 * one.static_branch.length);
  EXPECT_EQ(one.grain_density, 6 / std::numbers::pi);
}

}  // namespace
}  // namespace bagnold::closure

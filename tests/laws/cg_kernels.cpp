// Every registered coarse-graining function: normalisation, widths, derivatives, line integrals.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "laws/registries.hpp"

using namespace bagnold;

namespace {

template <class F>
double integrate(F f, double a, double b, int panels = 2000) {  // composite four-point Gauss rule
  const double x[2] = {0.3399810435848563, 0.8611363115940526}, w[2] = {0.6521451548625461, 0.3478548451374538};
  double sum = 0;
  const double h = (b - a) / panels;
  for (int p = 0; p < panels; ++p)
    for (int k = 0; k < 2; ++k)
      for (double s : {-1.0, 1.0}) sum += w[k] * f(a + h * (p + 0.5 + 0.5 * s * x[k]));
  return 0.5 * h * sum;
}

template <class F>
void for_each_kernel(F f) {
  laws::CgKernels::for_each([&](auto kernel) {
    SCOPED_TRACE(std::string(kernel.name));
    kernel.width = 0.37;
    f(kernel);
  });
}

double sphere(int dimension) {
  return dimension == 1 ? 2 : dimension == 2 ? 2 * std::numbers::pi : 4 * std::numbers::pi;
}

}  // namespace

TEST(CgKernels, IntegrateToOneWithTheirWidthAsStandardDeviation) {
  for_each_kernel([](const auto& k) {
    for (int D = 1; D <= 3; ++D) {
      const double c = k.support(D);
      const double mass =
          sphere(D) * integrate([&](double r) { return std::pow(r, D - 1) * k.density(r * r, D); }, 0, c);
      const double r2 = sphere(D) * integrate([&](double r) { return std::pow(r, D + 1) * k.density(r * r, D); }, 0, c);
      EXPECT_NEAR(mass, 1, 1e-12) << D;
      EXPECT_NEAR(r2 / D, 0.37 * 0.37, 1e-12) << D;
      EXPECT_EQ(k.density(1.0001 * c * c, D), 0);
    }
  });
}

TEST(CgKernels, AreNonNegativeAndDoNotIncrease) {
  for_each_kernel([](const auto& k) {
    for (int D = 1; D <= 3; ++D)
      for (double r = 0, last = k.density(0, D); r < 9 * k.width; r += 0.01) {
        const double w = k.density(r * r, D);
        EXPECT_GE(w, 0);
        EXPECT_LE(w, last * (1 + 1e-14));
        last = w;
      }
  });
}

TEST(CgKernels, DerivativesAreDerivatives) {
  for_each_kernel([](const auto& k) {
    using Kernel = std::decay_t<decltype(k)>;
    const int smooth = std::is_same_v<Kernel, laws::CgGaussian> ? 7 : std::is_same_v<Kernel, laws::CgLucy> ? 4 : 0;
    const double h = 1e-4 * k.width;
    for (int n = -2; n < smooth; ++n)
      for (double z : {-0.83, -0.31, -0.11, 0.2, 0.47, 0.9}) {
        const double numeric = (8 * (k.derivative(n, z + h) - k.derivative(n, z - h)) - k.derivative(n, z + 2 * h) +
                                k.derivative(n, z - 2 * h)) /
                               (12 * h);
        EXPECT_NEAR(k.derivative(n + 1, z), numeric, 1e-8 * std::pow(k.width, -n - 2) * std::tgamma(n + 4))
            << n << " at " << z;
      }
    for (double z : {-0.5, 0.0, 0.3}) EXPECT_NEAR(k.derivative(0, z), k.density(z * z, 1), 1e-14);
    const double far = 20 * k.width;
    EXPECT_EQ(k.derivative(-1, -far), 0);
    EXPECT_EQ(k.derivative(-1, far), 1);
    EXPECT_NEAR(k.derivative(-2, -far), 0, 1e-14);
    EXPECT_NEAR(k.derivative(-2, far), far, 1e-13);
  });
}

TEST(CgKernels, LineIntegralsMatchQuadrature) {
  for_each_kernel([](const auto& k) {
    using Kernel = std::decay_t<decltype(k)>;
    const bool jumps = std::is_same_v<Kernel, laws::CgHeaviside>;
    for (int D = 1; D <= 3; ++D)
      for (double a : {0.0, 0.15, 0.61})
        for (auto [u0, u1] : {std::pair{-0.4, 0.7}, std::pair{0.1, 0.3}, std::pair{-5.0, -0.2}, std::pair{-9.0, 9.0}}) {
          if (D == 1 && a > 0) continue;
          const double c = k.support(D), lo = std::max(u0, -c), hi = std::min(u1, c);
          const double exact = integrate([&](double u) { return k.density(a * a + u * u, D); }, lo, hi, 4000);
          EXPECT_NEAR(k.line(a * a, u0, u1, D), exact, jumps ? 2e-3 : 1e-11) << D << " " << a << " " << u0;
        }
  });
}

// Integrating the Gaussian over a direction gives the Gaussian of one dimension less.
TEST(CgKernels, GaussianMarginalsAreGaussians) {
  const laws::CgGaussian k{0.4};
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(k.line(0.09, -infinity, infinity, 3), k.density(0.09, 2), 1e-14);
  EXPECT_NEAR(k.line(0.09, -infinity, infinity, 2), k.density(0.09, 1), 1e-14);
}

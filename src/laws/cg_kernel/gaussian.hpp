// The Gaussian of the paper, cut at eight widths.
#pragma once
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <tuple>

#include "core/fields.hpp"

namespace bagnold::laws {

// W_D(r) = exp(-r^2 / 2 w^2) / (sqrt(2 pi) w)^D for r < 8 w, else 0. The mass beyond the cut is 1.2e-15 for D = 1
// (1.3e-13 for D = 3): below round-off, so nothing is renormalised and W and its integrals stay the same function.
struct CgGaussian {
  static constexpr std::string_view name = "gaussian";
  static constexpr std::string_view summary = "normalised Gaussian, cut at eight widths";
  static constexpr std::string_view source = "Weinhart et al. 2012, section 3.2.1";
  double width = 0.25;
  static constexpr auto fields() {
    return std::tuple{field("width", "length", "standard deviation of the kernel in each direction (w of the paper)",
                            &CgGaussian::width, positive())};
  }

  // Powers that a profile keeps of the place in a bin, and bins per cut-off; see cg/moments.hpp.
  static constexpr int expansion_terms = 9, bins_per_support = 16;

  double support(int /*dimension*/) const { return 8 * width; }

  // W_D at squared distance r2, per length^D.
  double density(double r2, int dimension) const {
    const double c = support(dimension);
    if (r2 >= c * c) return 0;
    const double g = 1 / (std::sqrt(2 * std::numbers::pi) * width);
    return std::exp(-r2 / (2 * width * width)) * (dimension == 1 ? g : dimension == 2 ? g * g : g * g * g);
  }

  // Integral of W_D(sqrt(a2 + u^2)) over u from u0 to u1: along a straight line that passes at squared distance a2.
  double line(double a2, double u0, double u1, int dimension) const {
    const double c = support(dimension);
    if (a2 >= c * c) return 0;
    const double across = dimension == 1 ? 1 : density(a2, dimension - 1);
    return across * (derivative(-1, u1) - derivative(-1, u0));
  }

  // n-th derivative of W_1 at z; n = -1 is the integral from -infinity, n = -2 the integral of that.
  double derivative(int n, double z) const {
    const double x = z / width, g = density(z * z, 1);
    if (n == -1) return std::abs(z) >= support(1) ? (z > 0 ? 1.0 : 0.0) : 0.5 * std::erfc(-x / std::numbers::sqrt2);
    if (n == -2) return z * derivative(-1, z) + width * width * g;
    double he = 1, previous = 0;  // Hermite polynomials: He_{k+1} = x He_k - k He_{k-1}
    for (int k = 0; k < n; ++k) {
      const double next = x * he - k * previous;
      previous = he;
      he = -next / width;  // every derivative brings a factor -1/w
      previous = -previous / width;
    }
    return he * g;
  }
};

}  // namespace bagnold::laws

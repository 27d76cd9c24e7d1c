// Lucy's kernel: compact, twice continuously differentiable.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <tuple>

#include "core/fields.hpp"

namespace bagnold::laws {

// W_D(r) = N_D (1 + 3 q)(1 - q)^3, q = r/c < 1. The cut-off c is set so that the standard deviation in each direction
// is `width`, which makes results comparable with those of the Gaussian: c = w sqrt(21/2), w sqrt(56/5), w sqrt(12).
struct CgLucy {
  static constexpr std::string_view name = "lucy";
  static constexpr std::string_view summary = "(1 + 3q)(1 - q)^3 with the standard deviation of the width asked for";
  static constexpr std::string_view source = "Lucy 1977, Astron. J. 82, 1013";
  double width = 0.25;
  static constexpr auto fields() {
    return std::tuple{field("width", "length",
                            "standard deviation of the kernel in each direction (cut-off 3.2 to 3.5 w)", &CgLucy::width,
                            positive())};
  }

  static constexpr int bins_per_support = 64;
  static constexpr int expansion_terms = 7;  // a polynomial of degree 6 after two integrations: nothing is neglected

  double support(int dimension) const {
    return width * std::sqrt(dimension == 1 ? 10.5 : dimension == 2 ? 11.2 : 12.0);
  }

  double density(double r2, int dimension) const {
    const double c = support(dimension);
    if (r2 >= c * c) return 0;
    const double q = std::sqrt(r2) / c, p = 1 - q;
    return norm(dimension) * (1 + 3 * q) * p * p * p;
  }

  double line(double a2, double u0, double u1, int dimension) const {
    const double c = support(dimension);
    if (a2 >= c * c) return 0;
    const double half = std::sqrt(c * c - a2);
    u0 = std::clamp(u0, -half, half);
    u1 = std::clamp(u1, -half, half);
    return norm(dimension) * (line_primitive(a2, u1, c) - line_primitive(a2, u0, c));
  }

  double derivative(int n, double z) const {
    const double c = support(1), q = std::min(std::abs(z) / c, 1.0), sign = z < 0 ? -1 : 1;
    if (n == -1 && q >= 1) return z > 0 ? 1 : 0;
    if (n == -1) return 0.5 + sign * 1.25 * q * (1 + q * q * (-2 + q * (2 - 0.6 * q)));
    if (n == -2)  // the even part, E'(q) = Phi - 1/2, is 1/8 at q = 0 and 1/2 at the cut-off
      return std::abs(z) >= c ? std::max(z, 0.0)
                              : z / 2 + c * (0.125 + 1.25 * q * q * (0.5 + q * q * (-0.5 + q * (0.4 - 0.1 * q))));
    if (q >= 1 || n > 4) return 0;
    std::array<double, 5> a{1, 0, -6, 8, -3};
    double factor = 1.25 / c;
    for (int k = 0; k < n; ++k) {
      for (std::size_t j = 0; j < 4; ++j) a[j] = static_cast<double>(j + 1) * a[j + 1];
      a[4] = 0;
      factor *= sign / c;
    }
    return factor * (a[0] + q * (a[1] + q * (a[2] + q * (a[3] + q * a[4]))));
  }

 private:
  double norm(int dimension) const {
    const double c = support(dimension), pi = std::numbers::pi;
    return dimension == 1 ? 5 / (4 * c) : dimension == 2 ? 5 / (pi * c * c) : 105 / (16 * pi * c * c * c);
  }
  // Primitive of 1 - 6 R^2/c^2 + 8 R^3/c^3 - 3 R^4/c^4 with R^2 = a2 + u^2.
  static double line_primitive(double a2, double u, double c) {
    const double u2 = u * u, R2 = a2 + u2, R = std::sqrt(R2), c2 = c * c;
    const double int_R2 = u * (a2 + u2 / 3), int_R4 = u * (a2 * a2 + u2 * (2 * a2 / 3 + u2 / 5));
    const double int_R = 0.5 * (u * R + (a2 > 0 ? a2 * std::asinh(u / std::sqrt(a2)) : 0.0));
    const double int_R3 = 0.25 * u * R2 * R + 0.75 * a2 * int_R;
    return u - 6 * int_R2 / c2 + 8 * int_R3 / (c2 * c) - 3 * int_R4 / (c2 * c2);
  }
};

}  // namespace bagnold::laws

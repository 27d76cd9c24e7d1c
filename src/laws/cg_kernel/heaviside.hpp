// The ball: what counts within a fixed distance. Discontinuous, so gradients of its fields are not defined at a point.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <tuple>

#include "core/fields.hpp"

namespace bagnold::laws {

// W_D(r) = 1 / (volume of the D-ball of radius c) for r < c. The cut-off is set so that the standard deviation in each
// direction is `width`: c = w sqrt(3), 2 w, w sqrt(5).
struct CgHeaviside {
  static constexpr std::string_view name = "heaviside";
  static constexpr std::string_view summary =
      "constant inside a ball with the standard deviation of the width asked for";
  static constexpr std::string_view source = "Weinhart et al. 2012, section 3.2.1 (any normalised function will do)";
  double width = 0.25;
  static constexpr auto fields() {
    return std::tuple{field("width", "length",
                            "standard deviation of the kernel in each direction (cut-off 1.7 to 2.2 w)",
                            &CgHeaviside::width, positive())};
  }

  static constexpr int bins_per_support = 64;
  static constexpr int expansion_terms = 3;  // a polynomial of degree 2 after two integrations: nothing is neglected

  double support(int dimension) const { return width * std::sqrt(dimension + 2.0); }

  double density(double r2, int dimension) const {
    const double c = support(dimension);
    return r2 < c * c ? norm(dimension) : 0;
  }

  double line(double a2, double u0, double u1, int dimension) const {
    const double c = support(dimension);
    if (a2 >= c * c) return 0;
    const double half = std::sqrt(c * c - a2);
    return norm(dimension) * (std::clamp(u1, -half, half) - std::clamp(u0, -half, half));
  }

  double derivative(int n, double z) const {
    const double c = support(1);
    const bool inside = std::abs(z) < c;
    if (n == -2) return inside ? (z + c) * (z + c) / (4 * c) : std::max(z, 0.0);
    if (n == -1) return std::clamp((z + c) / (2 * c), 0.0, 1.0);
    return n == 0 && inside ? 1 / (2 * c) : 0;
  }

 private:
  double norm(int dimension) const {
    const double c = support(dimension), pi = std::numbers::pi;
    return dimension == 1 ? 1 / (2 * c) : dimension == 2 ? 1 / (pi * c * c) : 3 / (4 * pi * c * c * c);
  }
};

}  // namespace bagnold::laws

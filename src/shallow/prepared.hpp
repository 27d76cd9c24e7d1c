// Closures made ready for loops: tangents taken, functions of the friction angle replaced by polynomials in mu.
#pragma once
#include <array>
#include <functional>

#include "closure/closure_set.hpp"
#include "shallow/definition.hpp"

namespace bagnold::shallow {

// Chebyshev interpolant of a smooth function on [lo, hi], evaluated by Horner's rule; constant beyond the ends.
struct Polynomial {
  static constexpr int degree = 9;
  std::array<double, degree + 1> coefficient{};
  double middle = 0, inverse_half_width = 0;
  static Polynomial fit(double lo, double hi, const std::function<double(double)>& f);
  double operator()(double x) const {
    double s = (x - middle) * inverse_half_width;
    s = s < -1 ? -1 : s;
    s = s > 1 ? 1 : s;
    double y = coefficient[degree];
    for (int k = degree - 1; k >= 0; --k) y = y * s + coefficient[static_cast<std::size_t>(k)];
    return y;
  }
};

struct PreparedClosure {
  closure::ClosureSet set;
  double g = 1, normal = 1;                 // full and normal gravity
  double dry_density_depth = 0;             // D below which a cell is dry
  double inverse_tip_depth = 1e300;
  double rho = 1, K = 1, alpha = 1;         // constant closures; else representative values
  Polynomial rho_of_mu, K_of_mu;            // functions of mu within the validity range
  bool alpha_varies = false;
  laws::StrainModelShapeFactor strain;
  double strain_mu1 = 0, strain_mu2 = 0;
};

PreparedClosure prepare(const Definition& setup);

// Closures of one cell by the exact laws, slowly: the twin the row kernels are tested against.
struct CellClosure {
  double h, mu, rho, K, alpha, slope;
};
CellClosure closure_at(const PreparedClosure& p, double h, double speed);      // h given
CellClosure closure_of_cell(const PreparedClosure& p, double D, double speed);  // rho(h, u) h = D given
// Friction with static branch of the chosen law.
double basal_friction(const closure::ClosureSet& set, double g, double h, double froude);
double starting_friction(const closure::ClosureSet& set, double g, double h);

}  // namespace bagnold::shallow

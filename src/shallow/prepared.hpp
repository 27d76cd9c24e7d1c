// Closures made ready for loops: tangents taken, functions of the friction angle replaced by polynomials in mu.
#pragma once
#include <array>
#include <cmath>
#include <functional>

#include "closure/closure_set.hpp"
#include "core/numeric.hpp"
#include "shallow/definition.hpp"

namespace bagnold::shallow {

// Chebyshev interpolant of a smooth function on [lo, hi], evaluated by Estrin's scheme; constant beyond the ends.
struct Polynomial {
  static constexpr int degree = 9;
  std::array<double, degree + 1> coefficient{};
  double middle = 0, inverse_half_width = 0;
  static Polynomial fit(double lo, double hi, const std::function<double(double)>& f);
  template <class N>
  [[gnu::always_inline]] N operator()(const N& x) const {
    const N s = min(max((x - middle) * inverse_half_width, N(-1.0)), N(1.0));
    const auto pair = [&](std::size_t k) { return mul_add(N(coefficient[k + 1]), s, N(coefficient[k])); };
    const N s2 = s * s, s4 = s2 * s2;
    const N low = mul_add(pair(2), s2, pair(0)), high = mul_add(pair(6), s2, pair(4));
    return mul_add(mul_add(pair(8), s4, high), s4, low);
  }
};

// Friction laws with their static branch, tangents taken.
template <class R>
struct PreparedLaws;
template <class... Laws>
struct PreparedLaws<Registry<Laws...>> {
  using Any = std::variant<laws::BasalFriction<typename Laws::Prepared>...>;
};
using AnyFriction = PreparedLaws<laws::FrictionLaws>::Any;

struct CellRow;
struct PreparedClosure;
// Closures of `n` cells that hold D > 0 and run at speeds s = F sqrt(h). All rows reach two packs beyond n.
using MeasureKernel = void (*)(const PreparedClosure&, int n, const double* D, const double* s, CellRow&);
MeasureKernel choose_measure(const closure::ClosureSet& set);

struct PreparedClosure {
  closure::ClosureSet set;
  AnyFriction friction = laws::BasalFriction(laws::Coulomb{}.prepared(1), laws::StaticBranch{});
  double g = 1, normal = 1;  // full and normal gravity
  double inverse_root_normal = 1;
  double dry_density_depth = 0;  // D below which a cell is dry
  double inverse_tip_depth = 1e300;
  double rho = 1, K = 1, alpha = 1;  // constant closures; else those at the smallest angle
  double typical_rho = 1;            // in the middle of the range
  Polynomial rho_of_mu, K_of_mu;     // functions of mu within the validity range
  double mu_lo = 0, mu_hi = 1e300;   // its ends
  bool alpha_varies = false;
  laws::StrainModelShapeFactor strain;
  double strain_mu1 = 0, strain_mu2 = 0;
  MeasureKernel measure = nullptr;
};

template <class Law>
const laws::BasalFriction<typename Law::Prepared>& prepared_law(const PreparedClosure& p) {
  return std::get<laws::BasalFriction<typename Law::Prepared>>(p.friction);
}

PreparedClosure prepare(const Definition& setup);

// Closures of one cell by the exact laws, slowly: the twin the row kernels are tested against.
struct CellClosure {
  double h, mu, rho, K, alpha, slope;
};
CellClosure closure_at(const PreparedClosure& p, double h, double speed);       // h given
CellClosure closure_of_cell(const PreparedClosure& p, double D, double speed);  // rho(h, u) h = D given
// Friction with static branch of the chosen law.
double basal_friction(const closure::ClosureSet& set, double g, double h, double froude);
double starting_friction(const closure::ClosureSet& set, double g, double h);

}  // namespace bagnold::shallow

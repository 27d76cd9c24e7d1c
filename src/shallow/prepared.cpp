#include "shallow/prepared.hpp"

#include <cmath>
#include <numbers>

namespace bagnold::shallow {
namespace {
double degrees(double mu) { return std::atan(mu) * 180 / std::numbers::pi; }

template <class F>
auto with_friction(const closure::ClosureSet& set, double g, F&& f) {
  return std::visit([&](const auto& law) { return f(laws::BasalFriction(law.prepared(g), set.static_branch)); },
                    set.friction);
}
double clamped(double theta, const closure::Validity& v) {
  return std::min(std::max(theta, v.theta_lo_deg), v.theta_hi_deg);
}
}  // namespace

Polynomial Polynomial::fit(double lo, double hi, const std::function<double(double)>& f) {
  constexpr int n = degree + 1;
  Polynomial p;
  p.middle = 0.5 * (lo + hi);
  p.inverse_half_width = hi > lo ? 2 / (hi - lo) : 0;
  std::array<double, n> chebyshev{};
  for (int k = 0; k < n; ++k) {
    double sum = 0;
    for (int j = 0; j < n; ++j) {
      const double phase = std::numbers::pi * (j + 0.5) / n;
      sum += f(p.middle + 0.5 * (hi - lo) * std::cos(phase)) * std::cos(k * phase);
    }
    chebyshev[static_cast<std::size_t>(k)] = sum * (k == 0 ? 1.0 : 2.0) / n;
  }
  std::array<double, n> previous{}, current{};  // T_{k-1}, T_k as powers of x
  previous[0] = 1;
  current[1] = 1;
  for (std::size_t i = 0; i < n; ++i) p.coefficient[i] = chebyshev[0] * previous[i] + chebyshev[1] * current[i];
  for (std::size_t k = 2; k < n; ++k) {
    std::array<double, n> next{};
    for (std::size_t i = 0; i < n; ++i) next[i] = (i > 0 ? 2 * current[i - 1] : 0) - previous[i];
    for (std::size_t i = 0; i < n; ++i) p.coefficient[i] += chebyshev[k] * next[i];
    previous = current;
    current = next;
  }
  return p;
}

PreparedClosure prepare(const Definition& setup) {
  PreparedClosure p;
  p.set = setup.closure;
  p.measure = choose_measure(p.set);
  p.g = setup.gravity.g;
  p.friction = std::visit(
      [&](const auto& law) -> AnyFriction { return laws::BasalFriction(law.prepared(p.g), p.set.static_branch); },
      p.set.friction);
  p.normal = setup.gravity.normal;
  p.inverse_root_normal = 1 / std::sqrt(p.normal);
  const closure::Validity& v = p.set.validity;
  const double lo = std::tan(v.theta_lo_deg * std::numbers::pi / 180),
               hi = std::tan(v.theta_hi_deg * std::numbers::pi / 180);
  const auto density = [&](double mu) {
    return p.set.grain_density *
           std::visit([&](const auto& l) { return l.volume_fraction(degrees(mu)); }, p.set.density);
  };
  const auto ratio = [&](double mu) {
    return std::visit([&](const auto& l) { return l.ratio(degrees(mu)); }, p.set.stress_ratio);
  };
  if (!p.set.is_constant()) {
    p.mu_lo = lo;
    p.mu_hi = hi;
    p.rho_of_mu = Polynomial::fit(lo, hi, density);
    p.K_of_mu = Polynomial::fit(lo, hi, ratio);
  }
  p.rho = density(lo);
  p.K = ratio(lo);
  p.typical_rho = density(p.set.is_constant() ? lo : 0.5 * (lo + hi));
  if (const auto* strain = std::get_if<laws::StrainModelShapeFactor>(&p.set.shape_factor)) {
    p.alpha_varies = true;
    p.strain = *strain;
    p.strain_mu1 = laws::tan_deg(strain->delta1_deg);
    p.strain_mu2 = laws::tan_deg(strain->delta2_deg);
  } else {
    p.alpha = std::get<laws::ConstantShapeFactor>(p.set.shape_factor).alpha;
  }
  p.dry_density_depth = setup.scheme.dry_depth * p.rho;
  if (setup.scheme.tip_depth > 0) p.inverse_tip_depth = 1 / setup.scheme.tip_depth;
  return p;
}

CellClosure closure_at(const PreparedClosure& p, double h, double speed) {
  const double froude = h > 0 ? speed / std::sqrt(p.normal * h) : 0;
  const double mu = std::visit([&](const auto& law) { return law.prepared(p.g).mu(h, froude); }, p.set.friction);
  const double theta = clamped(degrees(mu), p.set.validity);
  CellClosure c{h, mu, 0, 0, 0, 0};
  c.rho = p.set.grain_density * std::visit([&](const auto& l) { return l.volume_fraction(theta); }, p.set.density);
  c.K = std::visit([&](const auto& l) { return l.ratio(theta); }, p.set.stress_ratio);
  const double alpha = std::visit([&](const auto& l) { return l.factor(h, laws::tan_deg(theta)); }, p.set.shape_factor);
  const double x = std::min(1.0, h * p.inverse_tip_depth);
  c.slope = (alpha - 1) * 6 * x * x * (1 - x);
  c.alpha = 1 + (alpha - 1) * x * x * (3 - 2 * x);
  return c;
}

CellClosure closure_of_cell(const PreparedClosure& p, double D, double speed) {
  if (!(D > p.dry_density_depth)) return {0, 0, p.rho, p.K, 1, 0};
  double lo = D / p.set.grain_density, hi = 100 * lo;  // bisection: rho(h) h grows with h
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (lo + hi);
    (closure_at(p, middle, speed).rho * middle < D ? lo : hi) = middle;
  }
  return closure_at(p, 0.5 * (lo + hi), speed);
}

double basal_friction(const closure::ClosureSet& set, double g, double h, double froude) {
  return with_friction(set, g, [&](const auto& f) { return f.mu(h, froude); });
}
double starting_friction(const closure::ClosureSet& set, double g, double h) {
  return with_friction(set, g, [&](const auto& f) { return f.mu_start(h); });
}

}  // namespace bagnold::shallow

// Closures and friction of a row of cells, instantiated for every law.
#include <cmath>

#include "shallow/rows.hpp"

namespace bagnold::shallow {
namespace {

inline double larger(double a, double b) { return a > b ? a : b; }
inline double smaller(double a, double b) { return a < b ? a : b; }

// h from rho(h, u) h = D by the secant method on h - D/rho(h). |d ln rho/d ln h| < 0.2 for every closure in use, so
// four evaluations after the first leave an error below 1e-12.
constexpr int density_iterations = 4;

template <class Law, bool constant, bool terrain>
void closure_row(const PreparedClosure& p, int n, const double* __restrict D, const double* __restrict Mx,
                 const double* __restrict My, CellRow& row) {
  const laws::BasalFriction law(std::get<Law>(p.set.friction).prepared(p.g), p.set.static_branch);
  const double dry = p.dry_density_depth, inverse_tip = p.inverse_tip_depth;
  const double inverse_rho = 1 / p.rho, alpha0 = p.alpha;
  const bool alpha_varies = p.alpha_varies;
  const laws::StrainModelShapeFactor strain = p.strain;
  const Polynomial rho_of_mu = p.rho_of_mu, K_of_mu = p.K_of_mu;
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    const bool wet = D[k] > dry;
    const double inv = wet ? 1 / D[k] : 0;
    const double u = Mx[k] * inv, v = My[k] * inv;
    double h = wet ? D[k] * inverse_rho : 0, rho = p.rho, K = p.K, alpha = alpha0;
    if constexpr (!constant) {
      double speed2 = u * u + v * v, normal = p.normal;
      if constexpr (terrain) {
        const double w = u * row.bx[k] + v * row.by[k];
        speed2 += w * w;
        normal *= row.c[k];
      }
      const double s = std::sqrt(speed2 / normal);  // F = s/sqrt(h)
      const auto mu_at = [&](double at) { return law.dynamic.mu(at, s / std::sqrt(at + 1e-300)); };
      double h0 = h, e0 = h0 - D[k] / rho_of_mu(mu_at(h0));
      double h1 = h0 - e0;
      for (int it = 0; it < density_iterations; ++it) {
        const double e1 = h1 - D[k] / rho_of_mu(mu_at(h1)), change = e1 - e0;
        const double next = h1 - (change != 0 ? e1 * ((h1 - h0) / change) : e1);
        h0 = h1;
        e0 = e1;
        h1 = next;
      }
      h = wet ? h1 : 0;
      const double mu = mu_at(h);
      rho = rho_of_mu(mu);
      K = K_of_mu(mu);
      const double varying = strain.prepared_factor(h, mu, p.strain_mu1, p.strain_mu2);
      alpha = alpha_varies ? varying : alpha0;
    }
    const double x = smaller(1, h * inverse_tip);
    row.h[k] = h;
    row.u[k] = u;
    row.v[k] = v;
    row.rho[k] = rho;
    row.K[k] = K;
    row.alpha[k] = 1 + (alpha - 1) * (x * x * (3 - 2 * x));
    row.slope[k] = (alpha - 1) * (6 * x * x * (1 - x));
    row.hold[k] = law.mu_start(h);
    row.rest[k] = (u == 0) & (v == 0) ? 1 : 0;
  }
}

// Implicit friction. Stage 1 is backward Euler; stage 2 is the trapezoidal rule, whose explicit part is cut where it would
// take more than half of the momentum (there it is backward Euler again). The law is linearised about the speed the stage
// began with, so steady uniform flow stays for any dt. A layer that friction can hold for the whole step stops exactly.
template <class Law, bool terrain>
void friction_row(const PreparedClosure& p, const FrictionArgs& a) {
  const laws::BasalFriction law(std::get<Law>(p.set.friction).prepared(p.g), p.set.static_branch);
  const double dry = p.dry_density_depth, dt = a.dt, g = p.normal;
  const bool second = a.stage == 2;
  const double *__restrict h = a.h, *__restrict u = a.u, *__restrict v = a.v, *__restrict rho = a.rho;
  const double *__restrict D_new = a.D_new, *__restrict Msx = a.Msx, *__restrict Msy = a.Msy;
  const double *D_old = a.D_old, *Mx_old = a.Mx_old, *My_old = a.My_old;
  double *friction = a.friction, *Mx = a.Mx, *My = a.My;
  const auto norm = [&](double x, double y, int k) {
    double s = x * x + y * y;
    if constexpr (terrain) {
      const double w = x * a.bx[k] + y * a.by[k];
      s += w * w;
    }
    return std::sqrt(s);
  };
#pragma GCC ivdep
  for (int k = 0; k < a.n; ++k) {
    double N = g;
    if constexpr (terrain) N = larger(0, g * a.c[k] + a.bend[k]);
    double mx = Msx[k], my = Msy[k], weight = 1;
    const double s1 = norm(u[k], v[k], k);
    if (second) {
      const bool was_wet = D_old[k] > dry;
      const double inv = was_wet ? 1 / D_old[k] : 0, s0 = norm(Mx_old[k], My_old[k], k) * inv;
      const double full = dt * friction[k], used = smaller(0.5 * full, 0.5 * s0);
      const double share = s0 > 0 ? used / s0 : 0;
      mx -= share * Mx_old[k];
      my -= share * My_old[k];
      weight = full > 0 ? 1 - used / full : 1;
    } else {
      const double root0 = std::sqrt(N * h[k]), F0 = root0 > 0 ? s1 / root0 : 0;
      friction[k] = N * law.mu(h[k], F0);
    }
    const bool wet = D_new[k] > dry;
    const double inv_D = wet ? 1 / D_new[k] : 0, h_new = D_new[k] / rho[k];
    const double root = std::sqrt(N * h_new) + 1e-150, F = s1 / root;
    const double mu = law.mu(h_new, F), steep = larger(0, law.dmu_dF(h_new, F) / root);
    const double m = norm(mx, my, k) * inv_D, impulse = weight * dt * N;
    const double moving = (m - impulse * (mu - steep * s1)) / (1 + impulse * steep);
    const double started = m - impulse * law.mu_start(h_new);
    const double s = larger(0, s1 > 0 ? moving : started), factor = m > 0 ? s / m : 0;
    Mx[k] = wet ? mx * factor : 0;
    My[k] = wet ? my * factor : 0;
  }
}

template <class Law>
LawKernels kernels_of(bool constant, bool terrain) {
  LawKernels k;
  if (terrain) {
    k.closures = constant ? closure_row<Law, true, true> : closure_row<Law, false, true>;
    k.friction = friction_row<Law, true>;
  } else {
    k.closures = constant ? closure_row<Law, true, false> : closure_row<Law, false, false>;
    k.friction = friction_row<Law, false>;
  }
  return k;
}

}  // namespace

LawKernels choose_kernels(const closure::ClosureSet& set, bool terrain) {
  return std::visit([&](const auto& law) { return kernels_of<std::decay_t<decltype(law)>>(set.is_constant(), terrain); },
                    set.friction);
}

}  // namespace bagnold::shallow

// Closures and friction of a row of cells, instantiated for every law.
#include <cmath>

#include "core/unrolled.hpp"
#include "shallow/rows.hpp"

namespace bagnold::shallow {
namespace {

inline double larger(double a, double b) { return a > b ? a : b; }
inline double smaller(double a, double b) { return a < b ? a : b; }

// h from rho(h, u) h = D by the secant method on h - D/rho(h). |d ln rho/d ln h| < 0.2 for every closure in use, so
// four evaluations after the first leave an error below 1e-12.
constexpr int density_iterations = 4;

// Friction angle, density and stress ratio of `n` cells that hold `D` > 0 and run at speeds s = F sqrt(h).
template <class Law>
void measured_row(const PreparedClosure& p, int n, const double* __restrict D, const double* __restrict s,
                  double* __restrict h, double* __restrict mu, double* __restrict rho, double* __restrict K) {
  const typename Law::Prepared law = prepared_law<Law>(p).dynamic;
  const Polynomial rho_of_mu = p.rho_of_mu, K_of_mu = p.K_of_mu;
  const double inverse_rho = 1 / p.rho;
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    const double mass = D[k], speed = s[k];
    const auto mu_at = [&](double at) __attribute__((always_inline)) { return law.mu(at, speed / std::sqrt(at)); };
    double h0 = mass * inverse_rho, e0 = h0 - mass / rho_of_mu(mu_at(h0));
    double h1 = h0 - e0;
    unrolled<density_iterations>([&](int) __attribute__((always_inline)) {
      const double e1 = h1 - mass / rho_of_mu(mu_at(h1)), change = e1 - e0;
      const double slope = (h1 - h0) * change / (change * change + 1e-80);  // 0 once converged
      h0 = h1;
      e0 = e1;
      h1 -= e1 * slope;
    });
    const double m = mu_at(h1);
    h[k] = h1;
    mu[k] = m;
    rho[k] = rho_of_mu(m);
    K[k] = K_of_mu(m);
  }
}

void shape_row(const PreparedClosure& p, int n, const double* __restrict h, const double* __restrict mu,
               double* __restrict alpha) {
  const laws::StrainModelShapeFactor strain = p.strain;
  const double mu1 = p.strain_mu1, mu2 = p.strain_mu2, lo = p.mu_lo, hi = p.mu_hi;
#pragma omp simd
  for (int k = 0; k < n; ++k) alpha[k] = strain.prepared_factor(h[k], smaller(hi, larger(lo, mu[k])), mu1, mu2);
}

template <class Law, bool constant, bool terrain>
void closure_row(const PreparedClosure& p, int n, const double* __restrict D, const double* __restrict Mx,
                 const double* __restrict My, CellRow& row) {
  const auto& law = prepared_law<Law>(p);
  const double dry = p.dry_density_depth, inverse_tip = p.inverse_tip_depth, inverse_rho = 1 / p.rho;
  const double normal = p.normal, rho0 = p.rho, K0 = p.K, alpha0 = p.alpha;
  const double least = larger(dry, 1e-200);
  alignas(64) Row safe, speed, mu;
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    const double inv = D[k] > dry ? 1 / D[k] : 0;
    const double u = Mx[k] * inv, v = My[k] * inv;
    row.u[k] = u;
    row.v[k] = v;
    row.rest[k] = (u == 0) & (v == 0) ? 1 : 0;
    row.h[k] = D[k] * inverse_rho;
    row.rho[k] = rho0;
    row.K[k] = K0;
    row.alpha[k] = alpha0;
    if constexpr (!constant) {
      double speed2 = u * u + v * v, gn = normal;
      if constexpr (terrain) {
        const double w = u * row.bx[k] + v * row.by[k];
        speed2 += w * w;
        gn *= row.c[k];
      }
      safe[k] = larger(D[k], least);
      speed[k] = std::sqrt(speed2 / gn);
    }
  }
  if constexpr (!constant) {
    measured_row<Law>(p, n, safe, speed, row.h, mu, row.rho, row.K);
    if (p.alpha_varies) shape_row(p, n, row.h, mu, row.alpha);
  }
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    const double h = D[k] > dry ? row.h[k] : 0, x = smaller(1, h * inverse_tip), extra = row.alpha[k] - 1;
    row.h[k] = h;
    row.alpha[k] = 1 + extra * (x * x * (3 - 2 * x));
    row.slope[k] = extra * (6 * x * x * (1 - x));
    row.hold[k] = law.mu_start(h);
  }
}

// Implicit friction. Stage 1 is backward Euler; stage 2 is the trapezoidal rule, or backward Euler again where friction
// would take all the momentum within the step. The law is linearised about the state the stage began with, so steady
// uniform flow stays for any dt. A layer that friction can hold for the whole step stops exactly.
template <class Law, bool terrain, bool second>
void friction_stage(const PreparedClosure& p, const FrictionArgs& a) {
  const auto& law = prepared_law<Law>(p);
  const double dry = p.dry_density_depth, dt = a.dt, g = p.normal;
  const double* __restrict h = a.h, * __restrict u = a.u, * __restrict v = a.v, * __restrict hold = a.hold;
  const double* __restrict D_new = a.D_new, * __restrict Msx = a.Msx, * __restrict Msy = a.Msy;
  const double *Mx_old = a.Mx_old, *My_old = a.My_old;
  double* __restrict share = a.share, * __restrict Mx = a.Mx, * __restrict My = a.My;
  const double *bx = a.bx, *by = a.by, *slope_cosine = a.c, *bend = a.bend;
  const int n = a.n;
  const auto norm = [&](double x, double y, int k) {
    double s = x * x + y * y;
    if constexpr (terrain) {
      const double w = x * bx[k] + y * by[k];
      s += w * w;
    }
    return std::sqrt(s);
  };
#pragma omp simd
  for (int k = 0; k < n; ++k) {
    double N = g;
    if constexpr (terrain) N = larger(0, g * slope_cosine[k] + bend[k]);
    const double s = norm(u[k], v[k], k), inv_root = 1 / (std::sqrt(N * h[k]) + 1e-150);
    const laws::MuAndSlope f = law.mu_and_slope(h[k], s * inv_root, hold[k]);
    double mx = Msx[k], my = Msy[k], weight = 1;
    if constexpr (second) {
      mx -= share[k] * Mx_old[k];
      my -= share[k] * My_old[k];
      weight = share[k] > 0 ? 0.5 : 1;
    } else {  // the part of the momentum that the explicit half of stage 2 will take
      const double full = dt * N * f.mu;
      share[k] = full < s ? 0.5 * (full / s) : 0;
    }
    const double D = D_new[k], m = norm(mx, my, k), impulse = weight * dt * N, steep = f.slope * inv_root;
    const double resisting = s > 0 ? f.mu - steep * s : hold[k], stiff = s > 0 ? impulse * steep : 0;
    const double left = larger(0, m - D * impulse * resisting);
    const double factor = (D > dry) & (m > 0) ? left / (m * (1 + stiff)) : 0;
    Mx[k] = mx * factor;
    My[k] = my * factor;
  }
}

template <class Law, bool terrain>
void friction_row(const PreparedClosure& p, const FrictionArgs& a) {
  a.stage == 2 ? friction_stage<Law, terrain, true>(p, a) : friction_stage<Law, terrain, false>(p, a);
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
  return std::visit(
      [&](const auto& law) { return kernels_of<std::decay_t<decltype(law)>>(set.is_constant(), terrain); },
      set.friction);
}

}  // namespace bagnold::shallow

// Closures and friction of a row of cells, instantiated for every law.
#include <cmath>

#include "shallow/rows.hpp"

namespace bagnold::shallow {
namespace {

// h from rho(h, u) h = D by the secant method on rho h - D. |d ln rho/d ln h| < 0.2 for every closure in use, so that
// three steps after the first leave a relative error below 1e-11 (see the twin in tests/).
constexpr int density_iterations = 3;

// Friction, density, stress ratio and shape factor of `n` cells that hold D > 0 and run at speeds s = F sqrt(h). One loop
// an iteration: the chain of operations on one pack is long, but that on the next is independent of it.
template <class Law>
void measure(const PreparedClosure& p, int n, const Row& D, const Row& s, CellRow& row) {
  const typename Law::Prepared& law = prepared_law<Law>(p).dynamic;
  alignas(64) Row h_before, e_before;
  const auto mu_at = [&](const Pack& h, int k) { return law.mu(h, Pack::load(s + k) * rsqrt(h)); };
  const auto excess = [&](const Pack& h, int k) { return p.rho_of_mu(mu_at(h, k)) * h - Pack::load(D + k); };
  for (int k = 0; k < n; k += Pack::lanes) {
    const Pack h = Pack::load(D + k) * (1 / p.rho), e = excess(h, k);
    h.store(h_before + k);
    e.store(e_before + k);
    (h - e * (1 / p.rho)).store(row.h + k);
  }
  for (int iteration = 0; iteration < density_iterations; ++iteration)
    for (int k = 0; k < n; k += Pack::lanes) {
      const Pack h = Pack::load(row.h + k), e = excess(h, k), change = e - Pack::load(e_before + k);
      const Pack step = e * (h - Pack::load(h_before + k)) * change / (change * change + 1e-200);  // 0 once converged
      h.store(h_before + k);
      e.store(e_before + k);
      (h - step).store(row.h + k);
    }
  for (int k = 0; k < n; k += Pack::lanes) {
    const Pack h = Pack::load(row.h + k), mu = mu_at(h, k);
    (Pack::load(D + k) / h).store(row.rho + k);
    p.K_of_mu(mu).store(row.K + k);
    if (p.alpha_varies)
      p.strain.prepared_factor(h, max(min(mu, p.mu_hi), p.mu_lo), p.strain_mu1, p.strain_mu2).store(row.alpha + k);
  }
}

template <class Law, bool constant, bool terrain>
void closure_row(const PreparedClosure& p, int n, const double* D_row, const double* Mx, const double* My,
                 CellRow& row) {
  const laws::BasalFriction<typename Law::Prepared>& law = prepared_law<Law>(p);
  const double dry = p.dry_density_depth, least = dry > 1e-100 ? dry : 1e-100;
  alignas(64) Row safe, speed;
  row.any_rest = false;
  for (int k = 0; k < n; k += Pack::lanes) {
    const Pack D = Pack::load_unaligned(D_row + k), D_safe = max(D, least);
    const Pack inv = select(D > dry, 1.0 / D_safe, 0.0);
    const Pack u = Pack::load_unaligned(Mx + k) * inv, v = Pack::load_unaligned(My + k) * inv;
    Pack speed2 = u * u + v * v, inverse_normal = 1 / p.normal;
    if constexpr (terrain) {
      const Pack w = u * Pack::load(row.bx + k) + v * Pack::load(row.by + k);
      speed2 = speed2 + w * w;
      inverse_normal = 1.0 / (p.normal * Pack::load(row.c + k));
    }
    u.store(row.u + k);
    v.store(row.v + k);
    const Mask rest = !(speed2 > 0.0);
    row.any_rest |= any(rest & lanes_between(0, n - k));
    select(rest, Pack(1.0), 0.0).store(row.rest + k);
    if constexpr (constant) {
      (D * (1 / p.rho)).store(row.h + k);
      Pack(p.rho).store(row.rho + k);
      Pack(p.K).store(row.K + k);
    } else {
      D_safe.store(safe + k);
      sqrt(speed2 * inverse_normal).store(speed + k);
    }
  }
  if constexpr (!constant) measure<Law>(p, n, safe, speed, row);
  for (int k = 0; k < n; k += Pack::lanes) {
    const Pack h = select(Pack::load_unaligned(D_row + k) > dry, Pack::load(row.h + k), 0.0);
    const Pack x = min(h * p.inverse_tip_depth, 1.0), alpha = p.alpha_varies ? Pack::load(row.alpha + k) : p.alpha;
    const Pack extra = alpha - 1.0;
    h.store(row.h + k);
    (1.0 + extra * (x * x * (3.0 - 2.0 * x))).store(row.alpha + k);
    (extra * (6.0 * x * x * (1.0 - x))).store(row.slope + k);
    law.mu_start(h).store(row.hold + k);
  }
}

// Implicit friction. Stage 1 is backward Euler; stage 2 is the trapezoidal rule, or backward Euler again where friction
// would take all the momentum within the step. The law is linearised about the state the stage began with, so steady
// uniform flow stays for any dt. A layer that friction can hold for the whole step stops exactly.
template <class Law, bool terrain, bool second>
void friction_stage(const PreparedClosure& p, const FrictionArgs& a) {
  const laws::BasalFriction<typename Law::Prepared>& law = prepared_law<Law>(p);
  const double dry = p.dry_density_depth, dt = a.dt;
  for (int k = 0; k < a.end; k += Pack::lanes) {
    const auto scratch = [&](const double* row) { return Pack::load(row + k); };
    const auto field = [&](const double* row) { return Pack::load_unaligned(row + k); };
    const auto norm = [&](const Pack& x, const Pack& y) {
      Pack s = x * x + y * y;
      if constexpr (terrain) {
        const Pack w = x * scratch(a.bx) + y * scratch(a.by);
        s = s + w * w;
      }
      return ieee_sqrt(s);
    };
    const Mask cells = lanes_between(a.begin - k, a.end - k);
    Pack N = p.normal;
    if constexpr (terrain) N = max(0.0, p.normal * scratch(a.c) + scratch(a.bend));
    const Pack h = scratch(a.h), hold = scratch(a.hold), s = norm(scratch(a.u), scratch(a.v));
    const Pack inv_root = rsqrt(max(N * h, 1e-300));
    const laws::MuAndSlopeOf<Pack> f = law.mu_and_slope(h, s * inv_root, hold);
    const Mask moving = s > 0.0;
    Pack mx = scratch(a.Msx), my = scratch(a.Msy), impulse = dt * N;
    if constexpr (second) {
      const Pack share = field(a.share);
      mx = mx - share * field(a.Mx_old);
      my = my - share * field(a.My_old);
      impulse = select(share > 0.0, 0.5 * impulse, impulse);
    } else {  // the part of the momentum that the explicit half of stage 2 will take
      const Pack full = impulse * f.mu;
      store_where(cells, select(full < s, 0.5 * (full / s), 0.0), a.share + k);
    }
    const Pack D = scratch(a.D_new), m = norm(mx, my), steep = f.slope * inv_root;
    const Pack resisting = select(moving, f.mu - steep * s, hold), stiff = select(moving, impulse * steep, 0.0);
    const Pack left = max(0.0, m - D * impulse * resisting);
    const Pack factor = select((D > dry) & (m > 0.0), left / (m * (1.0 + stiff)), 0.0);
    store_where(cells, mx * factor, a.Mx + k);
    store_where(cells, my * factor, a.My + k);
    store_where(cells, D, a.D + k);
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

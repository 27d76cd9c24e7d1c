// Closures and friction of a row of cells, instantiated for every law.
#include <cmath>

#include "shallow/rows.hpp"

namespace bagnold::shallow {
namespace {

template <class Law, bool constant, bool terrain>
void closure_row(const PreparedClosure& p, int n, const double* D_row, const double* Mx, const double* My,
                 CellRow& row) {
  const laws::BasalFriction<typename Law::Prepared>& law = prepared_law<Law>(p);
  const double dry = p.dry_density_depth, least = dry > 1e-100 ? dry : 1e-100;
  const auto settle = [&](int k, const Pack& h, const Pack& alpha)
      __attribute__((always_inline)) {  // what follows from thickness and shape factor
    const Pack x = min(h * p.inverse_tip_depth, 1.0), extra = alpha - 1.0;
    h.store(row.h + k);
    (1.0 + extra * (x * x * (3.0 - 2.0 * x))).store(row.alpha + k);
    (extra * (6.0 * x * x * (1.0 - x))).store(row.slope + k);
    law.mu_start(h).store(row.hold + k);
  };
  alignas(64) Row safe, ratio;
  row.any_rest = false;
  if (n <= 0) return;
  for (int k = 0; k < n; k += Pack::lanes) {
    const Pack D = Pack::load_unaligned(D_row + k), D_safe = max(D, least);
    const Mask wet = D > dry;
    const Pack inv = select(wet, 1.0 / D_safe, 0.0);
    const Pack u = Pack::load_unaligned(Mx + k) * inv, v = Pack::load_unaligned(My + k) * inv;
    Pack speed2 = u * u + v * v;
    if constexpr (terrain) {
      const Pack w = u * Pack::load(row.bx + k) + v * Pack::load(row.by + k);
      speed2 = speed2 + w * w;
    }
    const Pack speed = ieee_sqrt(speed2);
    u.store(row.u + k);
    v.store(row.v + k);
    speed.store(row.speed + k);
    row.any_rest |= any(!(speed > 0.0) & lanes_between(0, n - k));
    if constexpr (constant) {
      settle(k, select(wet, D * (1 / p.rho), 0.0), p.alpha);
      Pack(p.rho).store(row.rho + k);
      Pack(p.K).store(row.K + k);
    } else {
      D_safe.store(safe + k);
      if constexpr (terrain)
        (speed * rsqrt(p.normal * Pack::load(row.c + k))).store(ratio + k);
      else
        (speed * p.inverse_root_normal).store(ratio + k);
    }
  }
  if constexpr (!constant) {
    p.measure(p, n, safe, ratio, row);
    for (int k = 0; k < n; k += Pack::lanes)
      settle(k, select(Pack::load_unaligned(D_row + k) > dry, Pack::load(row.h + k), 0.0), Pack::load(row.alpha + k));
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
    const Pack h = scratch(a.h), hold = scratch(a.hold), s = scratch(a.speed);
    const Pack inv_root = rsqrt(max(N * h, 1e-300));
    const laws::MuAndSlopeOf<Pack> f = law.mu_and_slope(h, s * inv_root, hold);
    const Mask moving = s > 0.0;
    Pack mx = scratch(a.Msx), my = scratch(a.Msy), impulse = dt * N;
    const Pack full = impulse * f.mu, steep = f.slope * inv_root;
    if constexpr (second) {
      const Pack share = field(a.share);
      mx = mx - share * field(a.Mx_old);
      my = my - share * field(a.My_old);
      impulse = select(share > 0.0, 0.5 * impulse, impulse);
    }
    constexpr double least = 1e-100;  // keeps the product of speed and momentum in range
    const Pack D = scratch(a.D_new), m = norm(mx, my);
    const Pack resisting = select(moving, f.mu - steep * s, hold), stiff = select(moving, impulse * steep, 0.0);
    const Pack left = max(0.0, m - D * impulse * resisting), stiff_m = max(m, least) * (1.0 + stiff);
    Pack inverse;  // of stiff_m
    if constexpr (second) {
      inverse = 1.0 / stiff_m;
    } else {  // the part of the momentum that the explicit half of stage 2 will take
      const Pack safe = max(s, least), both = 1.0 / (safe * stiff_m);
      inverse = both * safe;
      store_where(cells, select(full < s, 0.5 * full * (both * stiff_m), 0.0), a.share + k);
    }
    const Pack factor = select((D > dry) & (m > 0.0), left * inverse, 0.0);
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

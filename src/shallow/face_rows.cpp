// Reconstruction and fluxes of a row of faces.
//
// Edges: MUSCL with van Leer's limiter on h, u, v and on the surface K h + b, so that a lake at rest is reconstructed
// flat. Faces: hydrostatic reconstruction (Audusse et al. 2004) in the form of Chen & Noelle 2017, which also drives
// thin layers on steep steps, where the flow is slow; where its head exceeds the step, the bed is continuous (a fast thin
// layer would be blocked otherwise). Closures K, alpha, rho are averaged over the two cells, then HLL.
#include <algorithm>

#include "laws/flux/hll.hpp"
#include "shallow/rows.hpp"

namespace bagnold::shallow {
namespace {

// The two differences over a cell, and half of van Leer's slope: their harmonic mean, 0 at extrema. Never more than either
// difference, so edges of h are not negative. Differences whose product is not above `least` count as none.
struct Differences {
  static constexpr double least = 1e-100;
  Pack product, sum;
  Mask monotone;
  Differences(const Pack& a, const Pack& b) : product(a * b), sum(a + b), monotone(product > least) {
    sum = select(monotone, sum, 1.0);
  }
  Pack half_slope(const Pack& inverse_sum) const { return select(monotone, product * inverse_sum, 0.0); }
};

[[gnu::always_inline]] inline Differences differences(const double* before, const double* here, const double* after,
                                                      int k) {
  const Pack c = Pack::load_unaligned(here + k);
  return {c - Pack::load_unaligned(before + k), Pack::load_unaligned(after + k) - c};
}

// Slope of the bed: what the limited surface leaves after the limited depth. Differences are taken with the cell's own
// K, so that variations of K stay in the pressure.
template <Geometry G>
[[gnu::always_inline]] inline Pack bed_slope(const CellRow& rb, const CellRow& r, const CellRow& ra, int k, int shift,
                                             const Pack& depth_slope) {
  const auto before = [&](const Row& row) { return Pack::load_unaligned(row + k - shift); };
  const auto after = [&](const Row& row) { return Pack::load_unaligned(row + k + shift); };
  const auto here = [&](const Row& row) { return Pack::load_unaligned(row + k); };
  Pack push_b = before(rb.h), push = here(r.h), push_a = after(ra.h), c = 1.0;
  if constexpr (G == Geometry::terrain) {
    c = here(r.c);
    push_b = push_b * before(rb.c);
    push = push * c;
    push_a = push_a * after(ra.c);
  }
  const Pack K = here(r.K), b = here(r.b);
  const Pack low = K * (push - push_b) + (b - before(rb.b)), high = K * (push_a - push) + (after(ra.b) - b);
  const Differences surface(low, high);
  return surface.half_slope(1.0 / surface.sum) - K * c * depth_slope;
}

}  // namespace

template <Geometry G>
void slope_row(int end, bool second_order, const CellRow& before, const CellRow& here, const CellRow& after, int shift,
               SlopeRow& out) {
  if (!second_order)
    for (double* row : {out.h, out.u, out.v, out.b}) std::fill_n(row, row_size, 0.0);
  else
    for (int k = 0; k < end; k += Pack::lanes) {
      const Differences h = differences(before.h - shift, here.h, after.h + shift, k),
                        u = differences(before.u - shift, here.u, after.u + shift, k),
                        v = differences(before.v - shift, here.v, after.v + shift, k);
      // One division for all three. The sums are above 2 sqrt(least), so their product stays in range.
      const Pack uv = u.sum * v.sum, inverse = 1.0 / (h.sum * uv), per_uv = inverse * h.sum;
      const Pack h_slope = h.half_slope(inverse * uv);
      h_slope.store(out.h + k);
      u.half_slope(per_uv * v.sum).store(out.u + k);
      v.half_slope(per_uv * u.sum).store(out.v + k);
      if constexpr (G != Geometry::flat) bed_slope<G>(before, here, after, k, shift, h_slope).store(out.b + k);
    }
}

// Rise of the surface K h + b across each face, less the fall of the chart. A dry cell takes from a higher neighbour
// but gives nothing to a lower one.
template <Geometry G>
void drop_row(int end, const CellRow& before, const CellRow& after, int shift, const double* fall, double* drop) {
  for (int f = 0; f < end; f += Pack::lanes) {
    const auto B = [&](const Row& row) { return Pack::load_unaligned(row + f); };
    const auto A = [&](const Row& row) { return Pack::load_unaligned(row + f + shift); };
    const Pack hb = B(before.h), ha = A(after.h);
    Pack push_b = hb, push_a = ha;
    if constexpr (G == Geometry::terrain) {
      push_b = push_b * B(before.c);
      push_a = push_a * A(after.c);
    }
    Pack rise = 0.5 * (B(before.K) + A(after.K)) * (push_a - push_b) - Pack::load_unaligned(fall + f);
    if constexpr (G != Geometry::flat) rise = rise + (A(after.b) - B(before.b));
    const Mask blocked = ((rise > 0.0) & !(ha > 0.0)) | ((rise < 0.0) & !(hb > 0.0));
    select(blocked, 0.0, rise).store_unaligned(drop + f);
  }
}

namespace {

// What terrain adds to a face: cosine of the slope, inverse metric a^nn along the normal at the face and on both sides.
struct Metric {
  Pack c = 1.0, at_face = 1.0, before = 1.0, after = 1.0;
};

// A face is locked, without flux of mass, where both cells are at rest and friction can hold the surface between them:
// this is what keeps deposits in place to the last bit. The test is on the slope vector, so it turns with the grid.
template <Geometry G>
Mask locked_faces(const FaceArgs& a, int f, const Pack& K, const Metric& metric) {
  const CellRow &B = *a.before, &A = *a.after;
  const auto b = [&](const Row& row) { return Pack::load_unaligned(row + f); };
  const auto c = [&](const Row& row) { return Pack::load_unaligned(row + f + a.shift); };
  constexpr double round_off = 1e-15;
  const Pack hB = b(B.h), hA = c(A.h), rise = Pack::load_unaligned(a.drop + f);
  Pack size = K * (hB + hA);
  if constexpr (G != Geometry::flat) size = (abs(b(B.b)) + abs(c(A.b))) + size;
  const Pack normal = max(0.0, abs(rise) - round_off * size) * a.inv_d;
  const Pack wet_b = select(hB > 0.0, Pack(1.0), 0.0), wet_a = select(hA > 0.0, Pack(1.0), 0.0);
  const Pack share = select(wet_b + wet_a > 1.0, Pack(0.5), 1.0);
  const Pack tangent = share * (wet_b * b(a.along_y ? B.gx : B.gy) + wet_a * c(a.along_y ? A.gx : A.gy));
  Pack steepness = normal * normal + tangent * tangent, hold = max(b(B.hold), c(A.hold));
  if constexpr (G == Geometry::terrain) {
    const Pack n = 0.5 * (b(a.along_y ? B.by : B.bx) + c(a.along_y ? A.by : A.bx)),
               s = 0.5 * (b(a.along_y ? B.bx : B.by) + c(a.along_y ? A.bx : A.by));
    const Pack along = metric.c * (n * (rise * a.inv_d) + s * tangent);
    steepness = max(0.0, steepness - along * along);
    hold = hold * metric.c;
  }
  return !(hold * hold < steepness);
}

}  // namespace

namespace {

struct Fluxes {
  Pack mass, tangential, before, after, speed, locked;
};

template <Geometry G, bool may_lock>
[[gnu::always_inline]] inline Fluxes fluxes_at(const FaceArgs& a, int f) {
  const CellRow &B = *a.before, &A = *a.after;
  const SlopeRow &SB = *a.slope_before, &SA = *a.slope_after;
  const double g = a.normal_g;
  const auto b = [&](const Row& row) { return Pack::load_unaligned(row + f); };
  const auto c = [&](const Row& row) { return Pack::load_unaligned(row + f + a.shift); };
  const Pack K = 0.5 * (b(B.K) + c(A.K));
  Pack gK = g * K;
  Metric metric;
  if constexpr (G == Geometry::terrain) {
    const Pack cB = b(B.c), cA = c(A.c), nB = b(a.along_y ? B.by : B.bx), nA = c(a.along_y ? A.by : A.bx);
    metric.c = 0.5 * (cB + cA);
    metric.before = 1.0 - nB * nB * cB * cB;
    metric.after = 1.0 - nA * nA * cA * cA;
    metric.at_face = 0.5 * (metric.before + metric.after);
    gK = gK * metric.at_face * metric.c;
  }
  const laws::ShallowFace<Pack> face{0.5 * (b(B.rho) + c(A.rho)), 0.5 * (b(B.alpha) + c(A.alpha)), gK,
                                     max(b(B.slope), c(A.slope))};
  const auto normal = [&](const auto& row) -> const Row& { return a.along_y ? row.v : row.u; };
  const auto tangential = [&](const auto& row) -> const Row& { return a.along_y ? row.u : row.v; };
  laws::ShallowSide<Pack> left{b(B.h) + b(SB.h), b(normal(B)) + b(normal(SB)), b(tangential(B)) + b(tangential(SB))},
      right{c(A.h) - c(SA.h), c(normal(A)) - c(normal(SA)), c(tangential(A)) - c(tangential(SA))};
  Pack extra_left = 0.0, extra_right = 0.0;
  if constexpr (G != Geometry::flat) {
    const Pack b_plus = b(B.b) + b(SB.b), b_minus = c(A.b) - c(SA.b), Kc = K * metric.c, inv = 1.0 / Kc;
    const Pack psi_l = Kc * left.h, psi_r = Kc * right.h, eta_l = psi_l + b_plus, eta_r = psi_r + b_minus;
    const Pack low = min(max(b_plus, b_minus), min(eta_l, eta_r));
    const Pack push_l = max(0.0, min(eta_l - low, psi_l)), push_r = max(0.0, min(eta_r - low, psi_r));
    // A layer that runs fast enough climbs the step, however thin it is: towards a bed continuous at the face.
    const Pack climb = g * abs(b_plus - b_minus) + 1e-200, head = max(left.un * left.un, right.un * right.un);
    const Pack fast = min(max(head / climb - 1.0, 0.0), 1.0), slow = 1.0 - fast;
    const Pack step = slow * low + fast * (0.5 * (b(B.b) + c(A.b)));
    const Pack h_l = slow * (push_l * inv) + fast * left.h, h_r = slow * (push_r * inv) + fast * right.h;
    extra_left = g * metric.before * face.rho * (0.5 * (left.h + h_l)) * (step - b_plus);
    extra_right = g * metric.after * face.rho * (0.5 * (right.h + h_r)) * (step - b_minus);
    if constexpr (G == Geometry::terrain) {  // each cell sees the pressure with its own metric
      const Pack own = metric.at_face * metric.c, half = 0.5 * g * K * face.rho;
      extra_left = extra_left + half * (metric.before * b(B.c) - own) * (h_l * h_l);
      extra_right = extra_right + half * (metric.after * c(A.c) - own) * (h_r * h_r);
    }
    left.h = h_l;
    right.h = h_r;
  }
  laws::ShallowFlux<Pack> flux = laws::hll(face, left, right);
  Pack locked = 0.0;
  if constexpr (may_lock) {
    const Mask both_rest = !(max(b(B.speed), c(A.speed)) > 0.0);
    if (any(both_rest)) {
      const Mask m = both_rest & locked_faces<G>(a, f, K, metric);
      flux.mass = select(m, 0.0, flux.mass);
      flux.tangential = select(m, 0.0, flux.tangential);
      locked = select(m, Pack(1.0), 0.0);
    }
  }
  return {flux.mass, flux.tangential, flux.normal + extra_left, flux.normal + extra_right, flux.speed, locked};
}

template <Geometry G, bool may_lock>
void faces(const FaceArgs& a, FaceRow& out) {
  const FaceArgs args = a;
  abreast(
      args.end, [&](int f) __attribute__((always_inline)) { return fluxes_at<G, may_lock>(args, f); },
      [&](int f, const Fluxes& flux) __attribute__((always_inline)) {
        flux.mass.store(out.mass + f);
        flux.tangential.store(out.tangential + f);
        flux.before.store(out.before + f);
        if constexpr (G != Geometry::flat) flux.after.store(out.after + f);
        flux.speed.store(out.speed + f);
        if constexpr (may_lock) flux.locked.store(out.locked + f);
      });
}

}  // namespace

template <Geometry G>
void face_row(const FaceArgs& a, FaceRow& out) {
  a.before->any_rest || a.after->any_rest ? faces<G, true>(a, out) : faces<G, false>(a, out);
}

#define BAGNOLD_INSTANTIATE(G)                                                                           \
  template void slope_row<G>(int, bool, const CellRow&, const CellRow&, const CellRow&, int, SlopeRow&); \
  template void drop_row<G>(int, const CellRow&, const CellRow&, int, const double*, double*);           \
  template void face_row<G>(const FaceArgs&, FaceRow&);
BAGNOLD_INSTANTIATE(Geometry::flat)
BAGNOLD_INSTANTIATE(Geometry::bed)
BAGNOLD_INSTANTIATE(Geometry::terrain)
#undef BAGNOLD_INSTANTIATE

}  // namespace bagnold::shallow

// Reconstruction and fluxes of a row of faces.
//
// Edges: MUSCL with van Leer's limiter on h, u, v and on the surface K h + b, so that a lake at rest is reconstructed
// flat. Faces: hydrostatic reconstruction (Audusse et al. 2004) in the form of Chen & Noelle 2017, which also drives
// thin layers on steep steps, with the closures K, alpha, rho averaged over the two cells, then HLL.
#include <cmath>

#include "laws/flux/hll.hpp"
#include "shallow/rows.hpp"

namespace bagnold::shallow {
namespace {

inline double larger(double a, double b) { return a > b ? a : b; }
inline double smaller(double a, double b) { return a < b ? a : b; }

// Half of van Leer's slope: the harmonic mean of the two differences, 0 at extrema. Never more than either
// difference, so edges of h are not negative.
inline double half_slope(double a, double b) {
  const double product = a * b;
  return product > 0 ? product / (a + b) : 0;
}

void limit_row(int begin, int end, double order, const double* __restrict before, const double* __restrict here,
               const double* __restrict after, double* __restrict minus, double* __restrict plus) {
#pragma omp simd
  for (int k = begin; k < end; ++k) {
    const double s = order * half_slope(here[k] - before[k], after[k] - here[k]);
    minus[k] = here[k] - s;
    plus[k] = here[k] + s;
  }
}

// Bed at the edges: what the limited surface leaves after the limited depth. Differences are taken with the cell's own
// K, so that variations of K stay in the pressure. `before` and `after` start at the entry matched with `begin`.
template <Geometry G>
void bed_edges(int begin, int end, double order, const CellRow& rb, const CellRow& r, const CellRow& ra, int shift,
               EdgeRow& out) {
  const double *hb = rb.h - shift, *bb = rb.b - shift, *ha = ra.h + shift, *ba = ra.b + shift;
  const double *cb = rb.c - shift, *ca = ra.c + shift;
#pragma omp simd
  for (int k = begin; k < end; ++k) {
    double push_b = hb[k], push = r.h[k], push_a = ha[k], c = 1;
    if constexpr (G == Geometry::terrain) {
      c = r.c[k];
      push_b *= cb[k];
      push *= c;
      push_a *= ca[k];
    }
    const double low = r.K[k] * (push - push_b) + (r.b[k] - bb[k]), high = r.K[k] * (push_a - push) + (ba[k] - r.b[k]);
    const double surface = order * half_slope(low, high);
    const double depth = r.K[k] * c * order * half_slope(r.h[k] - hb[k], ha[k] - r.h[k]);
    out.b_minus[k] = r.b[k] - (surface - depth);
    out.b_plus[k] = r.b[k] + (surface - depth);
  }
}

}  // namespace

template <Geometry G>
void edge_row(int begin, int end, bool second_order, const CellRow& before, const CellRow& here, const CellRow& after,
              int shift, bool along_y, EdgeRow& out) {
  const double order = second_order ? 1 : 0;
  const auto limit = [&](const Row& b, const Row& c, const Row& a, Row& minus, Row& plus) {
    limit_row(begin, end, order, b - shift, c, a + shift, minus, plus);
  };
  limit(before.h, here.h, after.h, out.h_minus, out.h_plus);
  if (along_y) {
    limit(before.v, here.v, after.v, out.n_minus, out.n_plus);
    limit(before.u, here.u, after.u, out.t_minus, out.t_plus);
  } else {
    limit(before.u, here.u, after.u, out.n_minus, out.n_plus);
    limit(before.v, here.v, after.v, out.t_minus, out.t_plus);
  }
  if constexpr (G != Geometry::flat) bed_edges<G>(begin, end, order, before, here, after, shift, out);
}

// Rise of the surface K h + b across each face, less the fall of the chart. A dry cell takes from a higher neighbour
// but gives nothing to a lower one.
template <Geometry G>
void drop_row(int begin, int end, const CellRow& before, const CellRow& after, int shift, const double* fall,
              FaceRow& out) {
  const double *ha = after.h + shift, *ba = after.b + shift, *Ka = after.K + shift, *ca = after.c + shift;
#pragma omp simd
  for (int f = begin; f < end; ++f) {
    double push_b = before.h[f], push_a = ha[f];
    if constexpr (G == Geometry::terrain) {
      push_b *= before.c[f];
      push_a *= ca[f];
    }
    double rise = 0.5 * (before.K[f] + Ka[f]) * (push_a - push_b) - fall[f];
    if constexpr (G != Geometry::flat) rise += ba[f] - before.b[f];
    const bool blocked = ((rise > 0) & !(ha[f] > 0)) | ((rise < 0) & !(before.h[f] > 0));
    out.drop[f] = blocked ? 0 : rise;
  }
}

// A face is locked, without flux of mass, where both cells are at rest and friction can hold the surface between them:
// this is what keeps deposits in place to the last bit. The test is on the slope vector, so it turns with the grid.
template <Geometry G>
void face_row(const FaceArgs& a, FaceRow& out) {
  const CellRow &B = *a.before, &A = *a.after;
  const int o = a.shift;
  const double *h_plus = a.edge_before->h_plus, *n_plus = a.edge_before->n_plus, *t_plus = a.edge_before->t_plus,
               *b_plus = a.edge_before->b_plus;
  const double *h_minus = a.edge_after->h_minus + o, *n_minus = a.edge_after->n_minus + o,
               *t_minus = a.edge_after->t_minus + o, *b_minus = a.edge_after->b_minus + o;
  const double *hA = A.h + o, *KA = A.K + o, *rhoA = A.rho + o, *alphaA = A.alpha + o, *slopeA = A.slope + o,
               *holdA = A.hold + o, *restA = A.rest + o, *bA = A.b + o, *cA = A.c + o;
  const double *tangent_B = a.along_y ? B.gx : B.gy, *tangent_A = (a.along_y ? A.gx : A.gy) + o;
  const double *n_B = a.along_y ? B.by : B.bx,
               *n_A = (a.along_y ? A.by : A.bx) + o;  // terrain: bed slope along the normal
  const double *s_B = a.along_y ? B.bx : B.by, *s_A = (a.along_y ? A.bx : A.by) + o;
  const double g = a.normal_g, inv_d = a.inv_d;
  constexpr double round_off = 1e-15;
#pragma omp simd
  for (int f = a.begin; f < a.end; ++f) {
    const double K = 0.5 * (B.K[f] + KA[f]);
    double gK = g * K, cf = 1, metric_f = 1, metric_b = 1, metric_a = 1, hold_scale = 1;
    if constexpr (G == Geometry::terrain) {
      cf = 0.5 * (B.c[f] + cA[f]);
      metric_b = 1 - n_B[f] * n_B[f] * B.c[f] * B.c[f];  // a^nn, inverse metric along the normal
      metric_a = 1 - n_A[f] * n_A[f] * cA[f] * cA[f];
      metric_f = 0.5 * (metric_b + metric_a);
      gK *= metric_f * cf;
      hold_scale = cf;
    }
    const laws::ShallowFace face{0.5 * (B.rho[f] + rhoA[f]), 0.5 * (B.alpha[f] + alphaA[f]), gK,
                                 larger(B.slope[f], slopeA[f])};
    laws::ShallowSide left{h_plus[f], n_plus[f], t_plus[f]}, right{h_minus[f], n_minus[f], t_minus[f]};
    double extra_left = 0, extra_right = 0;
    if constexpr (G != Geometry::flat) {
      const double psi_l = K * cf * left.h, psi_r = K * cf * right.h;
      const double eta_l = psi_l + b_plus[f], eta_r = psi_r + b_minus[f];
      const double step = smaller(larger(b_plus[f], b_minus[f]), smaller(eta_l, eta_r));
      const double inv = 1 / (K * cf);
      const double h_l = larger(0, smaller(eta_l - step, psi_l)) * inv,
                   h_r = larger(0, smaller(eta_r - step, psi_r)) * inv;
      extra_left = g * metric_b * face.rho * (0.5 * (left.h + h_l)) * (step - b_plus[f]);
      extra_right = g * metric_a * face.rho * (0.5 * (right.h + h_r)) * (step - b_minus[f]);
      if constexpr (G == Geometry::terrain) {  // each cell sees the pressure with its own metric
        extra_left += 0.5 * g * K * face.rho * (metric_b * B.c[f] - metric_f * cf) * (h_l * h_l);
        extra_right += 0.5 * g * K * face.rho * (metric_a * cA[f] - metric_f * cf) * (h_r * h_r);
      }
      left.h = h_l;
      right.h = h_r;
    }
    const laws::ShallowFlux flux = laws::hll(face, left, right);

    const double wet_b = B.h[f] > 0 ? 1 : 0, wet_a = hA[f] > 0 ? 1 : 0, wet = wet_b + wet_a;
    const double slack = round_off * ((std::abs(B.b[f]) + std::abs(bA[f])) + K * (B.h[f] + hA[f]));
    const double normal = larger(0, std::abs(out.drop[f]) - slack) * inv_d;
    const double share = wet > 1 ? 0.5 : 1;
    const double tangent = share * (wet_b * tangent_B[f] + wet_a * tangent_A[f]);
    double steepness = normal * normal + tangent * tangent;
    if constexpr (G == Geometry::terrain) {
      const double nf = 0.5 * (n_B[f] + n_A[f]), sf = 0.5 * (s_B[f] + s_A[f]), signed_drop = out.drop[f] * inv_d;
      const double along = cf * (nf * signed_drop + sf * tangent);
      steepness = larger(0, steepness - along * along);
    }
    const double hold = larger(B.hold[f], holdA[f]) * hold_scale;
    const bool locked = (B.rest[f] * restA[f] != 0) & (steepness <= hold * hold);
    out.locked[f] = locked ? 1 : 0;
    out.mass[f] = locked ? 0 : flux.mass;
    out.before[f] = flux.normal + extra_left;
    out.after[f] = flux.normal + extra_right;
    out.tangential[f] = locked ? 0 : flux.tangential;
    out.speed[f] = flux.speed;
  }
}

#define BAGNOLD_INSTANTIATE(G)                                                                                    \
  template void edge_row<G>(int, int, bool, const CellRow&, const CellRow&, const CellRow&, int, bool, EdgeRow&); \
  template void drop_row<G>(int, int, const CellRow&, const CellRow&, int, const double*, FaceRow&);              \
  template void face_row<G>(const FaceArgs&, FaceRow&);
BAGNOLD_INSTANTIATE(Geometry::flat)
BAGNOLD_INSTANTIATE(Geometry::bed)
BAGNOLD_INSTANTIATE(Geometry::terrain)
#undef BAGNOLD_INSTANTIATE

}  // namespace bagnold::shallow

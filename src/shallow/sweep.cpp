// Cells of row r are closed, then the faces below and the row r - 2 are finished. Every cell is computed from the same
// numbers in the same order whatever the box, so neither tiles nor threads show in the result.
#include "shallow/sweep.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace bagnold::shallow {
namespace {

// In one dimension nothing crosses the faces above and below.
void still_rows(Scratch& w) {
  if (w.still_rows) return;
  w.still_rows = true;
  for (FaceRow& f : w.y_faces) {
    f = {};
    std::fill_n(f.locked, row_size, 1.0);
  }
  std::fill_n(w.cells[0].gy, row_size, 0.0);
  for (SlopeRow& e : w.y_slopes) e = {};
}

template <Geometry G>
class Sweep {
 public:
  Sweep(Solver& s, const Stage& stage, Scratch& w)
      : s_(s), g_(s.setup.grid), a_(stage), w_(w), t_(stage.cells), n_(t_.nx + 2 * reach) {}

  StageResult run() {
    if (!g_.two_d())
      run_row();
    else
      run_rows();
    result_.rate = largest(rate_);
    for (int k = 0; k < Pack::lanes; ++k) result_.wet += static_cast<std::int64_t>(wet_[k]);
    return result_;
  }

 private:
  CellRow& cell(int j) const { return w_.cells[j & 3]; }
  FaceRow& below(int j) const { return w_.y_faces[j & 1]; }  // faces between rows j - 1 and j

  // Of the first entry of a row, among columns or the faces after them.
  std::size_t column() const { return static_cast<std::size_t>(t_.i0 - reach + halo); }

  void run_rows() {
    w_.still_rows = false;
    for (int r = t_.j0 - reach; r < t_.j0 + t_.ny + reach; ++r) {
      close_cells(r);
      if (r > t_.j0 - reach) find_drops(r);
      if (r < t_.j0) continue;
      const int q = r - 1;  // its neighbours above and below are closed
      find_slopes(q);
      slope_row<G>(reach + t_.nx, second_order_, cell(q - 1), cell(q), cell(q + 1), 0, w_.y_slopes[q & 1]);
      if (q < t_.j0) continue;
      find_y_fluxes(q);
      if (q > t_.j0) finish(q - 1);
    }
  }

  void close_cells(int j) {
    const std::size_t at = g_.at(t_.i0 - reach, j);
    CellRow& row = cell(j);
    if constexpr (G != Geometry::flat) std::copy_n(&s_.bed[at], n_, row.b);
    if constexpr (G == Geometry::terrain) {
      std::copy_n(&s_.cosine[at], n_, row.c);
      std::copy_n(&s_.bed_x[at], n_, row.bx);
      std::copy_n(&s_.bed_y[at], n_, row.by);
    }
    const std::size_t here = a_.from.at(t_.i0 - reach, j);
    s_.kernels.closures(s_.closure, n_, a_.from.D + here, a_.from.Mx + here, a_.from.My + here, row);
    if (a_.number == 1) prefetch(a_.from, j + 1);
    if (a_.number == 2 && j > t_.j0) prefetch(a_.to, j - 1);  // will be the next to be finished
  }

  void prefetch(const ConstWindow& u, int j) const {
    const std::size_t at = u.at(t_.i0 - reach, j);
    for (int k = 0; k < n_; k += Pack::lanes)
      for (const double* field : {u.D, u.Mx, u.My}) __builtin_prefetch(field + at + k);
  }

  bool wall(Side side) const { return s_.setup.boundary[static_cast<std::size_t>(side)].kind == BoundaryKind::wall; }

  // Drops and slopes of the surface say whether faces are locked, which only matters between cells at rest; terrain also
  // needs them for its metric.
  bool needs_surface(int j) { return G == Geometry::terrain || cell(j).any_rest; }

  void find_drops(int j) {
    if (!needs_surface(j - 1) && !needs_surface(j)) return;
    const bool at_wall = (j == 0 && wall(Side::bottom)) || (j == g_.ny && wall(Side::top));
    std::fill_n(w_.fall, n_ + Pack::lanes, at_wall ? 0 : s_.fall_y);
    drop_row<G>(n_, cell(j - 1), cell(j), 0, w_.fall, below(j).drop);
  }

  // Slope of the surface in row j, from the drops over the four faces of each cell.
  void find_slopes(int j) {
    if (!needs_surface(j)) return;
    CellRow& row = cell(j);
    drop_row<G>(n_ - 1, row, row, 1, &s_.fall_x[column()], row.drop);
    const double half_x = 0.5 / g_.dx, half_y = 0.5 / g_.dy;
    const double *x = row.drop, *low = below(j).drop, *high = below(j + 1).drop;
    for (int k = 1; k < n_ - 1; ++k) row.gx[k] = half_x * (x[k - 1] + x[k]);
    if (g_.two_d())
      for (int k = 0; k < n_; ++k) row.gy[k] = half_y * (low[k] + high[k]);
  }

  void find_y_fluxes(int j) {
    face_row<G>({.end = reach + t_.nx,
                 .before = &cell(j - 1),
                 .after = &cell(j),
                 .shift = 0,
                 .slope_before = &w_.y_slopes[(j - 1) & 1],
                 .slope_after = &w_.y_slopes[j & 1],
                 .drop = below(j).drop,
                 .normal_g = s_.closure.normal,
                 .inv_d = 1 / g_.dy,
                 .along_y = true},
                below(j));
  }

  void find_x_fluxes(int j) {
    const CellRow& row = cell(j);
    slope_row<G>(n_ - 1, second_order_, row, row, row, 1, w_.x_slopes);
    face_row<G>({.end = reach + t_.nx,
                 .before = &row,
                 .after = &row,
                 .shift = 1,
                 .slope_before = &w_.x_slopes,
                 .slope_after = &w_.x_slopes,
                 .drop = row.drop,
                 .normal_g = s_.closure.normal,
                 .inv_d = 1 / g_.dx,
                 .along_y = false},
                w_.x_faces);
  }

  void run_row() {  // one dimension
    still_rows(w_);
    close_cells(0);
    find_slopes(0);
    finish(0);
  }

  void finish(int j) {
    find_x_fluxes(j);
    if constexpr (G == Geometry::terrain) curve(j);
    balance(j);
    apply_friction(j);
    record_crossings(j);
  }

  // Acceleration normal to the curved bed, b_jk u_j u_k cos(slope).
  void curve(int j) {
    const CellRow& row = cell(j);
    const std::size_t at = g_.at(t_.i0 - reach, j);
    for (int k = reach; k < reach + t_.nx; ++k) {
      const std::size_t c = at + static_cast<std::size_t>(k);
      const double u = row.u[k], v = row.v[k];
      w_.bend[k] = row.c[k] * ((s_.bed_xx[c] * (u * u) + s_.bed_yy[c] * (v * v)) + 2 * s_.bed_xy[c] * (u * v));
    }
  }

  // Area factors of a pack of cells: width of a channel, or area of sloping ground per horizontal area; inverse metric.
  struct Areas {
    Pack east = 1.0, west = 1.0, north = 1.0, south = 1.0, inverse = 1.0, metric_x = 1.0, metric_y = 1.0, c = 1.0;
  };
  [[gnu::always_inline]] inline Areas areas(int j, int k) const;
  // Rates of change of mass and momentum by fluxes and gravity; wave: rate at which waves cross the cell.
  struct Rates {
    Pack D, x, y, wave;
  };
  [[gnu::always_inline]] inline Rates rates(int j, int k) const;
  // Mass and momentum after fluxes and gravity, before friction.
  void balance(int j);
  void apply_friction(int j);
  void record_crossings(int j);

  Solver& s_;
  const Grid& g_;
  const Stage& a_;
  Scratch& w_;
  const Tile& t_;
  int n_;  // entries of a row
  const bool second_order_ = s_.setup.scheme.second_order;
  const double inv_dx_ = 1 / g_.dx, inv_dy_ = g_.two_d() ? 1 / g_.dy : 0;
  const double fall_x_ = s_.closure.normal * s_.setup.gravity.slope_x,  // acceleration along the chart
      fall_y_ = g_.two_d() ? s_.closure.normal * s_.setup.gravity.slope_y : 0;
  StageResult result_;
  Pack rate_ = 0.0, wet_ = 0.0;
};

template <Geometry G>
typename Sweep<G>::Areas Sweep<G>::areas(int j, int k) const {
  Areas a;
  if constexpr (G == Geometry::bed) {
    a.east = Pack::load_unaligned(&s_.width_face[column()] + k);
    a.west = Pack::load_unaligned(&s_.width_face[column()] + k - 1);
    a.inverse = Pack::load_unaligned(&s_.inverse_width[column()] + k);
  }
  if constexpr (G == Geometry::terrain) {
    const CellRow& row = cell(j);
    const double* J = &s_.area[g_.at(t_.i0 - reach, j)] + k;
    const auto face = [&](std::ptrdiff_t step) {
      return 0.5 * (Pack::load_unaligned(J) + Pack::load_unaligned(J + step));
    };
    a.east = face(1);
    a.west = face(-1);
    a.north = face(g_.stride());
    a.south = face(-g_.stride());
    a.c = a.inverse = Pack::load(row.c + k);
    a.metric_x = 1.0 - Pack::load(row.bx + k) * Pack::load(row.bx + k) * (a.c * a.c);
    a.metric_y = 1.0 - Pack::load(row.by + k) * Pack::load(row.by + k) * (a.c * a.c);
  }
  return a;
}

template <Geometry G>
typename Sweep<G>::Rates Sweep<G>::rates(int j, int k) const {
  const CellRow& row = cell(j);
  const FaceRow &X = w_.x_faces, &S = below(j), &N = below(j + 1);
  const auto at = [&](const double* r) { return Pack::load_unaligned(r + k); };
  const Areas A = areas(j, k);
  constexpr bool flat = G == Geometry::flat;
  const auto &x_after = flat ? X.before : X.after, &y_after = flat ? S.before : S.after;
  const double g = s_.closure.normal;
  const Pack D = at(row.rho) * at(row.h), ax = A.inverse * inv_dx_, ay = A.inverse * inv_dy_;
  Rates r;
  r.D = ax * (A.west * at(X.mass - 1) - A.east * at(X.mass)) + ay * (A.south * at(S.mass) - A.north * at(N.mass));
  Pack west = at(x_after - 1), east = at(X.before), south = at(y_after), north = at(N.before);
  const auto locked = [&](const double* face) { return at(face) > 0.0; };
  if (row.any_rest) {
    // Friction holds what presses on a locked face: a dry cell behind it feels nothing. (The little that comes in
    // through another face would be thrown.)
    const Mask dry = !(at(row.h) > 0.0);
    west = select(dry & locked(X.locked - 1), 0.0, west);
    east = select(dry & locked(X.locked), 0.0, east);
    south = select(dry & locked(S.locked), 0.0, south);
    north = select(dry & locked(N.locked), 0.0, north);
  }
  Pack push_x = A.west * west - A.east * east, push_y = A.south * south - A.north * north;
  if constexpr (!flat) {
    const Pack half_P = 0.5 * g * at(row.K) * D * at(row.h) * A.c;
    push_x = push_x + half_P * A.metric_x * (A.east - A.west);
    push_y = push_y + half_P * A.metric_y * (A.north - A.south);
  }
  r.x = ax * push_x + ay * (A.south * at(S.tangential) - A.north * at(N.tangential)) + D * fall_x_;
  r.y = ay * push_y + ax * (A.west * at(X.tangential - 1) - A.east * at(X.tangential)) + D * fall_y_;
  if constexpr (!flat) {
    r.x = r.x - 2 * inv_dx_ * g * A.metric_x * D * at(w_.x_slopes.b);
    r.y = r.y - 2 * inv_dy_ * g * A.metric_y * D * at(w_.y_slopes[j & 1].b);
  }
  if constexpr (G == Geometry::terrain) {
    const Pack cross = g * D * at(row.bx) * at(row.by) * (A.c * A.c), turn = D * at(w_.bend) * A.c;
    r.x = r.x + (cross * at(row.gy) - turn * at(row.bx));
    r.y = r.y + (cross * at(row.gx) - turn * at(row.by));
  }
  if (row.any_rest) {
    const Mask still = at(X.locked) * at(X.locked - 1) * at(N.locked) * at(S.locked) > 0.0;
    r.x = select(still, 0.0, r.x);
    r.y = select(still, 0.0, r.y);
  }
  r.wave =
      ax * max(A.east * at(X.speed), A.west * at(X.speed - 1)) + ay * max(A.north * at(N.speed), A.south * at(S.speed));
  return r;
}

template <Geometry G>
void Sweep<G>::balance(int j) {
  const double dt = a_.dt, dry = s_.closure.dry_density_depth, huge = std::numeric_limits<double>::max();
  const std::size_t from = a_.from.at(t_.i0 - reach, j), start = a_.start.at(t_.i0 - reach, j),
                    kept = a_.kept.at(t_.i0 - reach, j);
  for (int k = 0; k < reach + t_.nx; k += Pack::lanes) {
    const auto at = [&](const double* field, std::size_t first) { return Pack::load_unaligned(field + first + k); };
    const Mask cells = lanes_between(reach - k, reach + t_.nx - k);
    const Rates r = rates(j, k);
    Pack D_new = at(a_.from.D, from) + dt * r.D, mx = at(a_.start.Mx, start), my = at(a_.start.My, start);
    if (a_.number == 2) {
      D_new = 0.5 * (at(a_.start.D, start) + D_new);
      mx = mx + 0.5 * dt * (at(a_.kept.Mx, kept) + r.x);
      my = my + 0.5 * dt * (at(a_.kept.My, kept) + r.y);
    } else {
      mx = mx + dt * r.x;
      my = my + dt * r.y;
      store_where(cells, r.x, a_.kept.Mx + kept + k);
      store_where(cells, r.y, a_.kept.My + kept + k);
    }
    D_new.store(w_.D_new + k);
    mx.store(w_.Msx + k);
    my.store(w_.Msy + k);
    const Mask fine = !(D_new < 0.0) & (D_new + (abs(mx) + abs(my)) < huge);
    rate_ = max(rate_, select(cells, r.wave, 0.0));
    wet_ = wet_ + select(cells & (D_new > dry), Pack(1.0), 0.0);
    if (const std::uint32_t wrong = to_integer(cells & !fine); wrong != 0)
      result_.bad = static_cast<std::int64_t>(g_.at(t_.i0 - reach, j)) + k + std::countr_zero(wrong);
  }
}

template <Geometry G>
void Sweep<G>::apply_friction(int j) {
  const CellRow& row = cell(j);
  const std::size_t start = a_.start.at(t_.i0 - reach, j), kept = a_.kept.at(t_.i0 - reach, j),
                    to = a_.to.at(t_.i0 - reach, j);
  const FrictionArgs args{.begin = reach,
                          .end = reach + t_.nx,
                          .stage = a_.number,
                          .dt = a_.dt,
                          .h = row.h,
                          .speed = row.speed,
                          .hold = row.hold,
                          .c = row.c,
                          .bx = row.bx,
                          .by = row.by,
                          .bend = w_.bend,
                          .D_new = w_.D_new,
                          .Msx = w_.Msx,
                          .Msy = w_.Msy,
                          .Mx_old = a_.start.Mx + start,
                          .My_old = a_.start.My + start,
                          .share = a_.kept.D + kept,
                          .D = a_.to.D + to,
                          .Mx = a_.to.Mx + to,
                          .My = a_.to.My + to};
  s_.kernels.friction(s_.closure, args);
}

// Fluxes through the sides of the domain, of the tile's own cells.
template <Geometry G>
void Sweep<G>::record_crossings(int j) {
  const Tile& own = a_.own;
  if (j < own.j0 || j >= own.j0 + own.ny) return;
  auto& crossing = s_.crossing[a_.number - 1];
  const auto row_at = static_cast<std::size_t>(j);
  const auto area = [&](int i, int jj, int i2, int j2) {
    return G == Geometry::terrain ? 0.5 * (s_.area[g_.at(i, jj)] + s_.area[g_.at(i2, j2)]) : 1.0;
  };
  const auto after = [&](int i) { return i - t_.i0 + reach; };  // entry of the face after cell i, or of the cell
  if (own.i0 == 0) crossing[0][row_at] = -area(-1, j, 0, j) * s_.width_face[halo - 1] * w_.x_faces.mass[after(-1)];
  if (own.i0 + own.nx == g_.nx)
    crossing[1][row_at] = area(g_.nx - 1, j, g_.nx, j) * s_.width_face[static_cast<std::size_t>(g_.nx - 1 + halo)] *
                          w_.x_faces.mass[after(g_.nx - 1)];
  if (!g_.two_d()) return;
  for (int i = own.i0; i < own.i0 + own.nx; ++i) {
    const auto c = static_cast<std::size_t>(i);
    if (j == 0) crossing[2][c] = -area(i, -1, i, 0) * below(0).mass[after(i)];
    if (j == g_.ny - 1) crossing[3][c] = area(i, j, i, j + 1) * below(j + 1).mass[after(i)];
  }
}

}  // namespace

template <Geometry G>
StageResult sweep(Solver& s, const Stage& stage, Scratch& w) {
  return Sweep<G>(s, stage, w).run();
}
template StageResult sweep<Geometry::flat>(Solver&, const Stage&, Scratch&);
template StageResult sweep<Geometry::bed>(Solver&, const Stage&, Scratch&);
template StageResult sweep<Geometry::terrain>(Solver&, const Stage&, Scratch&);

}  // namespace bagnold::shallow

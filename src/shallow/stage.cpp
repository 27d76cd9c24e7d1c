// One Runge-Kutta stage over the active tiles. A tile is swept row by row with a few rows of scratch: cells of row r are
// closed, then the faces below and the row r - 2 are finished. Every cell is computed from the same numbers in the
// same order whatever the tiles and threads, so neither shows in the result.
#include <algorithm>
#include <cmath>

#include "shallow/solver.hpp"

namespace bagnold::shallow {
namespace {

struct Scratch {
  CellRow cells[4];
  EdgeRow x_edges, y_edges[2];
  FaceRow x_faces, y_faces[2];
  alignas(64) Row D_new, Msx, Msy, bend, fall;
  alignas(64) Row rate, bad, wet;
};

// Grids smaller than this are computed by one thread: starting the others would cost more.
constexpr std::size_t parallel_threshold = 20000;

struct Tile {
  int i0, j0, nx, ny;
};

// In one dimension nothing crosses the faces above and below.
void still_rows(Scratch& w) {
  for (FaceRow& f : w.y_faces) {
    f = {};
    std::fill_n(f.locked, row_size, 1.0);
  }
  std::fill_n(w.cells[0].gy, row_size, 0.0);
  for (EdgeRow& e : w.y_edges) e = {};
}

Tile tile_at(const Solver& s, int index) {
  const Grid& g = s.setup.grid;
  const int i0 = (index % s.tiles_x) * s.setup.scheme.tile_nx, j0 = (index / s.tiles_x) * s.setup.scheme.tile_ny;
  return {i0, j0, std::min(s.setup.scheme.tile_nx, g.nx - i0), std::min(s.setup.scheme.tile_ny, g.ny - j0)};
}

template <Geometry G>
class Sweep {
 public:
  Sweep(Solver& s, const State& state, int number, double dt, Scratch& w, const Tile& t)
      : s_(s),
        g_(s.setup.grid),
        number_(number),
        dt_(dt),
        w_(w),
        t_(t),
        n_(t.nx + 2 * halo),
        start_(state.now),
        from_(number == 1 ? state.now : s.predicted) {}

  void run() {
    if (!g_.two_d()) return run_row();
    for (int r = t_.j0 - halo; r < t_.j0 + t_.ny + halo; ++r) {
      close_cells(r);
      if (r < t_.j0) {
        if (r > t_.j0 - halo) find_drops(r);
        continue;
      }
      find_drops(r);
      const int q = r - 1;  // its neighbours above and below are closed
      find_slopes(q);
      edge_row<G>(0, n_, s_.setup.scheme.second_order, cell(q - 1), cell(q), cell(q + 1), 0, true, w_.y_edges[q & 1]);
      if (q < t_.j0) continue;
      find_y_fluxes(q);
      if (q > t_.j0) finish(q - 1);
    }
  }

 private:
  CellRow& cell(int j) { return w_.cells[j & 3]; }
  FaceRow& below(int j) { return w_.y_faces[j & 1]; }  // faces between rows j - 1 and j

  void close_cells(int j) {
    const std::size_t at = g_.at(t_.i0 - halo, j);
    CellRow& row = cell(j);
    if constexpr (G != Geometry::flat) std::copy_n(&s_.bed[at], n_, row.b);
    if constexpr (G == Geometry::terrain) {
      std::copy_n(&s_.cosine[at], n_, row.c);
      std::copy_n(&s_.bed_x[at], n_, row.bx);
      std::copy_n(&s_.bed_y[at], n_, row.by);
    }
    s_.kernels.closures(s_.closure, n_, &from_.D[at], &from_.Mx[at], &from_.My[at], row);
  }

  bool wall(Side side) const { return s_.setup.boundary[static_cast<std::size_t>(side)].kind == BoundaryKind::wall; }

  void find_drops(int j) {
    const bool at_wall = (j == 0 && wall(Side::bottom)) || (j == g_.ny && wall(Side::top));
    std::fill_n(w_.fall, n_, at_wall ? 0 : s_.fall_y);
    drop_row<G>(0, n_, cell(j - 1), cell(j), 0, w_.fall, below(j));
  }

  // Slope of the surface in row j, from the drops over the four faces of each cell.
  void find_slopes(int j) {
    drop_row<G>(0, n_ - 1, cell(j), cell(j), 1, &s_.fall_x[static_cast<std::size_t>(t_.i0)], w_.x_faces);
    CellRow& row = cell(j);
    const double half_x = 0.5 / g_.dx, half_y = 0.5 / g_.dy;
    const double *x = w_.x_faces.drop, *low = below(j).drop, *high = below(j + 1).drop;
    for (int k = 1; k < n_ - 1; ++k) row.gx[k] = half_x * (x[k - 1] + x[k]);
    if (g_.two_d())
      for (int k = 0; k < n_; ++k) row.gy[k] = half_y * (low[k] + high[k]);
  }

  void find_y_fluxes(int j) {
    face_row<G>({.begin = halo,
                 .end = halo + t_.nx,
                 .before = &cell(j - 1),
                 .after = &cell(j),
                 .shift = 0,
                 .edge_before = &w_.y_edges[(j - 1) & 1],
                 .edge_after = &w_.y_edges[j & 1],
                 .normal_g = s_.closure.normal,
                 .inv_d = 1 / g_.dy,
                 .along_y = true},
                below(j));
  }

  void find_x_fluxes(int j) {
    drop_row<G>(0, n_ - 1, cell(j), cell(j), 1, &s_.fall_x[static_cast<std::size_t>(t_.i0)], w_.x_faces);
    edge_row<G>(1, n_ - 1, s_.setup.scheme.second_order, cell(j), cell(j), cell(j), 1, false, w_.x_edges);
    face_row<G>({.begin = 1,
                 .end = halo + t_.nx,
                 .before = &cell(j),
                 .after = &cell(j),
                 .shift = 1,
                 .edge_before = &w_.x_edges,
                 .edge_after = &w_.x_edges,
                 .normal_g = s_.closure.normal,
                 .inv_d = 1 / g_.dx,
                 .along_y = false},
                w_.x_faces);
  }

  void run_row() {  // one dimension
    close_cells(0);
    find_slopes(0);
    finish(0);
  }

  void finish(int j) {
    find_x_fluxes(j);
    if constexpr (G == Geometry::terrain) curve(j);
    balance(j);
    apply_friction(j);
    record(j);
  }

  // Acceleration normal to the curved bed, b_jk u_j u_k cos(slope).
  void curve(int j) {
    const CellRow& row = cell(j);
    const std::size_t at = g_.at(t_.i0 - halo, j);
    for (int k = halo; k < halo + t_.nx; ++k) {
      const std::size_t c = at + static_cast<std::size_t>(k);
      const double u = row.u[k], v = row.v[k];
      w_.bend[k] = row.c[k] * ((s_.bed_xx[c] * (u * u) + s_.bed_yy[c] * (v * v)) + 2 * s_.bed_xy[c] * (u * v));
    }
  }

  // Mass and momentum after fluxes and gravity, before friction.
  void balance(int j);
  void apply_friction(int j);
  void record(int j);

  Solver& s_;
  const Grid& g_;
  int number_;
  double dt_;
  Scratch& w_;
  Tile t_;
  int n_;
  const Conserved &start_, &from_;
};

template <Geometry G>
void Sweep<G>::balance(int j) {
  const CellRow& row = cell(j);
  const FaceRow &X = w_.x_faces, &S = below(j), &N = below(j + 1);
  const EdgeRow &ex = w_.x_edges, &ey = w_.y_edges[j & 1];
  const bool two_d = g_.two_d();
  const double inv_dx = 1 / g_.dx, inv_dy = two_d ? 1 / g_.dy : 0, dt = dt_, g = s_.closure.normal;
  const double push_x = g * s_.setup.gravity.slope_x, push_y = two_d ? g * s_.setup.gravity.slope_y : 0;
  const auto shift = static_cast<std::size_t>(t_.i0);
  const double *Wf = &s_.width_face[shift], *inv_W = &s_.inverse_width[shift];
  const std::size_t at = g_.at(t_.i0 - halo, j);
  const std::ptrdiff_t up = g_.stride();
  const double *cosine = nullptr, *area = nullptr;
  if constexpr (G == Geometry::terrain) {
    cosine = &s_.cosine[at];
    area = &s_.area[at];
  }
  const double *D0 = &start_.D[at], *Mx0 = &start_.Mx[at], *My0 = &start_.My[at];
  const double* D1 = &from_.D[at];
  double *Lx = &s_.next.Mx[at], *Ly = &s_.next.My[at];
  const bool second = number_ == 2;
#pragma GCC ivdep
  for (int k = halo; k < halo + t_.nx; ++k) {
    // area factors: width of a channel, or area of sloping ground per horizontal area
    double We = Wf[k], Ww = Wf[k - 1], Wn = 1, Ws = 1, inv_A = inv_W[k], metric_x = 1, metric_y = 1, gx_c = g, gy_c = g;
    if constexpr (G == Geometry::terrain) {
      const double J = area[k], c2 = cosine[k] * cosine[k];
      We = 0.5 * (J + area[k + 1]);
      Ww = 0.5 * (area[k - 1] + J);
      Wn = 0.5 * (J + area[k + up]);
      Ws = 0.5 * (area[k - up] + J);
      inv_A = cosine[k];
      metric_x = 1 - row.bx[k] * row.bx[k] * c2;
      metric_y = 1 - row.by[k] * row.by[k] * c2;
      gx_c = g * metric_x * cosine[k];
      gy_c = g * metric_y * cosine[k];
    }
    const double D = row.rho[k] * row.h[k], half_PK = 0.5 * row.K[k] * D * row.h[k];
    const double ax = inv_A * inv_dx, ay = inv_A * inv_dy;
    const double rD = -(ax * (We * X.mass[k] - Ww * X.mass[k - 1]) + ay * (Wn * N.mass[k] - Ws * S.mass[k]));
    double rx = -(ax * ((We * X.before[k] - Ww * X.after[k - 1]) - half_PK * gx_c * (We - Ww)) +
                  ay * (Wn * N.tangential[k] - Ws * S.tangential[k]));
    double ry = -(ay * ((Wn * N.before[k] - Ws * S.after[k]) - half_PK * gy_c * (Wn - Ws)) +
                  ax * (We * X.tangential[k] - Ww * X.tangential[k - 1]));
    if constexpr (G != Geometry::flat) {
      rx -=
          inv_dx * g * metric_x * row.rho[k] * (0.5 * (ex.h_minus[k] + ex.h_plus[k])) * (ex.b_plus[k] - ex.b_minus[k]);
      ry -=
          inv_dy * g * metric_y * row.rho[k] * (0.5 * (ey.h_minus[k] + ey.h_plus[k])) * (ey.b_plus[k] - ey.b_minus[k]);
    }
    if constexpr (G == Geometry::terrain) {
      const double c2 = cosine[k] * cosine[k], cross = g * D * row.bx[k] * row.by[k] * c2;
      const double turn = D * w_.bend[k] * cosine[k];
      rx += cross * row.gy[k] - turn * row.bx[k];
      ry += cross * row.gx[k] - turn * row.by[k];
    }
    rx += D * push_x;
    ry += D * push_y;
    const bool still = (X.locked[k] * X.locked[k - 1] * N.locked[k] * S.locked[k] != 0);
    rx = still ? 0 : rx;
    ry = still ? 0 : ry;
    const double predicted = D1[k] + dt * rD;
    w_.D_new[k] = second ? 0.5 * (D0[k] + predicted) : predicted;
    w_.Msx[k] = second ? Mx0[k] + 0.5 * dt * (Lx[k] + rx) : Mx0[k] + dt * rx;
    w_.Msy[k] = second ? My0[k] + 0.5 * dt * (Ly[k] + ry) : My0[k] + dt * ry;
    Lx[k] = rx;
    Ly[k] = ry;
    const double east = We * X.speed[k], west = Ww * X.speed[k - 1], north = Wn * N.speed[k], south = Ws * S.speed[k];
    const double rate = ax * (east > west ? east : west) + ay * (north > south ? north : south);
    w_.rate[k] = rate > w_.rate[k] ? rate : w_.rate[k];
  }
}

template <Geometry G>
void Sweep<G>::apply_friction(int j) {
  const CellRow& row = cell(j);
  const std::size_t at = g_.at(t_.i0, j);
  Conserved& to = number_ == 1 ? s_.predicted : s_.next;
  const FrictionArgs args{.n = t_.nx,
                          .stage = number_,
                          .dt = dt_,
                          .h = row.h + halo,
                          .u = row.u + halo,
                          .v = row.v + halo,
                          .hold = row.hold + halo,
                          .c = row.c + halo,
                          .bx = row.bx + halo,
                          .by = row.by + halo,
                          .bend = w_.bend + halo,
                          .D_new = w_.D_new + halo,
                          .Msx = w_.Msx + halo,
                          .Msy = w_.Msy + halo,
                          .Mx_old = &start_.Mx[at],
                          .My_old = &start_.My[at],
                          .share = &s_.next.D[at],
                          .Mx = &to.Mx[at],
                          .My = &to.My[at]};
  s_.kernels.friction(s_.closure, args);
  std::copy_n(w_.D_new + halo, t_.nx, &to.D[at]);
}

// Boundary fluxes, and cells that went wrong.
template <Geometry G>
void Sweep<G>::record(int j) {
  const double dry = s_.closure.dry_density_depth;
  for (int k = halo; k < halo + t_.nx; ++k) {
    w_.bad[k] += w_.D_new[k] >= 0 && std::isfinite(w_.Msx[k]) && std::isfinite(w_.Msy[k]) ? 0 : 1;
    w_.wet[k] += w_.D_new[k] > dry ? 1 : 0;
  }
  auto& crossing = s_.crossing[number_ - 1];
  const auto row_at = static_cast<std::size_t>(j), column = static_cast<std::size_t>(t_.i0);
  const auto area = [&](int i, int jj, int i2, int j2) {
    return G == Geometry::terrain ? 0.5 * (s_.area[g_.at(i, jj)] + s_.area[g_.at(i2, j2)]) : 1.0;
  };
  if (t_.i0 == 0) crossing[0][row_at] = -area(-1, j, 0, j) * s_.width_face[1] * w_.x_faces.mass[1];
  if (t_.i0 + t_.nx == g_.nx)
    crossing[1][row_at] = area(g_.nx - 1, j, g_.nx, j) * s_.width_face[static_cast<std::size_t>(g_.nx + 1)] *
                          w_.x_faces.mass[halo + t_.nx - 1];
  if (!g_.two_d()) return;
  for (int i = 0; i < t_.nx; ++i) {
    const auto c = column + static_cast<std::size_t>(i);
    if (j == 0) crossing[2][c] = -area(t_.i0 + i, -1, t_.i0 + i, 0) * below(0).mass[halo + i];
    if (j == g_.ny - 1) crossing[3][c] = area(t_.i0 + i, j, t_.i0 + i, j + 1) * below(j + 1).mass[halo + i];
  }
}

template <Geometry G>
StageResult run_stage(Solver& s, const State& state, int number, double dt) {
  for (auto& side : s.crossing[number - 1]) std::fill(side.begin(), side.end(), 0.0);
  const auto tiles = static_cast<std::int64_t>(s.active.size());
  std::vector<StageResult>& results = s.tile_results;
  results.assign(s.active.size(), {});
  const bool worth_it = state.now.D.size() > parallel_threshold && tiles > 1;
#pragma omp parallel if (worth_it)
  {
    static thread_local std::unique_ptr<Scratch> scratch;
    if (!scratch) scratch = std::make_unique<Scratch>();
#pragma omp for schedule(dynamic, 1)
    for (std::int64_t a = 0; a < tiles; ++a) {
      const Tile tile = tile_at(s, s.active[static_cast<std::size_t>(a)]);
      std::fill_n(scratch->rate, row_size, 0.0);
      std::fill_n(scratch->bad, row_size, 0.0);
      std::fill_n(scratch->wet, row_size, 0.0);
      if (!s.setup.grid.two_d()) still_rows(*scratch);
      Sweep<G>(s, state, number, dt, *scratch, tile).run();
      StageResult& r = results[static_cast<std::size_t>(a)];
      for (int k = halo; k < halo + tile.nx; ++k) {
        r.rate = std::max(r.rate, scratch->rate[k]);
        r.wet += static_cast<std::int64_t>(scratch->wet[k]);
        if (scratch->bad[k] > 0) r.bad = static_cast<std::int64_t>(s.setup.grid.at(tile.i0 + k - halo, tile.j0));
      }
    }
  }
  StageResult all;
  for (const StageResult& r : results) {
    all.rate = std::max(all.rate, r.rate);
    all.wet += r.wet;
    if (r.bad >= 0) all.bad = r.bad;
  }
  return all;
}

}  // namespace

StageResult stage(Solver& s, const State& state, int number, double dt) {
  switch (s.geometry) {
    case Geometry::flat:
      return run_stage<Geometry::flat>(s, state, number, dt);
    case Geometry::bed:
      return run_stage<Geometry::bed>(s, state, number, dt);
    default:
      return run_stage<Geometry::terrain>(s, state, number, dt);
  }
}

}  // namespace bagnold::shallow

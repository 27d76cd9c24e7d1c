// Looking at the state: cells, rows, sums.
#include <cmath>

#include <algorithm>
#include <memory>

#include "shallow/solver.hpp"

namespace bagnold::shallow {

void set_cell(const Solver& s, State& state, int i, int j, double h, double u, double v) {
  const std::size_t c = s.setup.grid.at(i, j);
  double normal = s.closure.normal, w = 0;
  if (s.setup.terrain) {
    normal *= s.cosine[c];
    w = u * s.bed_x[c] + v * s.bed_y[c];
  }
  PreparedClosure local = s.closure;
  local.normal = normal;
  const double D = closure_at(local, h, std::sqrt(u * u + v * v + w * w)).rho * h;
  state.now.D[c] = D;
  state.now.Mx[c] = D * u;
  state.now.My[c] = D * v;
}

void view_cells(const Solver& s, const State& state, int i, int j, int n, CellRow& row) {
  const std::size_t at = s.setup.grid.at(i, j);
  if (s.setup.terrain)
    for (int k = 0; k < n; ++k) {
      const auto c = at + static_cast<std::size_t>(k);
      row.c[k] = s.cosine[c];
      row.bx[k] = s.bed_x[c];
      row.by[k] = s.bed_y[c];
    }
  s.kernels.closures(s.closure, n, &state.now.D[at], &state.now.Mx[at], &state.now.My[at], row);
}

CellView view_cell(const Solver& s, const State& state, int i, int j) {
  const auto row = std::make_unique<CellRow>();
  view_cells(s, state, i, j, 1, *row);
  double normal = s.closure.normal, speed2 = row->u[0] * row->u[0] + row->v[0] * row->v[0];
  if (s.setup.terrain) {
    const double w = row->u[0] * row->bx[0] + row->v[0] * row->by[0];
    normal *= row->c[0];
    speed2 += w * w;
  }
  const double froude = row->h[0] > 0 ? std::sqrt(speed2 / (normal * row->h[0])) : 0;
  return {row->h[0],
          row->u[0],
          row->v[0],
          row->rho[0],
          row->K[0],
          row->alpha[0],
          basal_friction(s.closure.set, s.closure.g, row->h[0], froude),
          froude};
}

void view_row(const Solver& s, const State& state, int j, std::vector<double>& h, std::vector<double>& u,
              std::vector<double>& v) {
  const Grid& g = s.setup.grid;
  for (auto* field : {&h, &u, &v}) field->resize(static_cast<std::size_t>(g.nx));
  const auto row = std::make_unique<CellRow>();
  for (int i = 0; i < g.nx; i += max_tile) {
    const int n = std::min(max_tile, g.nx - i);
    view_cells(s, state, i, j, n, *row);
    for (int k = 0; k < n; ++k) {
      const auto to = static_cast<std::size_t>(i + k);
      h[to] = row->h[k];
      u[to] = row->u[k];
      v[to] = row->v[k];
    }
  }
}

double total_mass(const Solver& s, const State& state) {
  const Grid& g = s.setup.grid;
  double sum = 0, lost = 0;  // Neumaier
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const std::size_t c = g.at(i, j);
      const double area = (s.setup.terrain ? s.area[c] : 1) / s.inverse_width[static_cast<std::size_t>(i + halo)];
      const double x = state.now.D[c] * area, t = sum + x;
      lost += std::abs(sum) >= std::abs(x) ? (sum - t) + x : (x - t) + sum;
      sum = t;
    }
  return (sum + lost) * g.cell_area();
}

double mass_crossed(const Solver&, const State& state) {
  double sum = 0;
  for (const auto& side : state.crossed)
    for (double m : side) sum += m;
  return sum;
}

bool is_dry(const Solver& s) {
  return std::all_of(s.wet_boxes.begin(), s.wet_boxes.end(), [](const Tile& box) { return box.empty(); });
}

bool at_rest(const Solver& s, const State& state) {
  for (const int tile : s.active) {  // elsewhere it is dry
    const Tile& box = s.boxes[static_cast<std::size_t>(tile)];
    for (int j = box.j0; j < box.j0 + box.ny; ++j) {
      const std::size_t at = s.setup.grid.at(box.i0, j);
      const auto moving = [](double m) { return m != 0; };
      if (std::any_of(&state.now.Mx[at], &state.now.Mx[at] + box.nx, moving) ||
          std::any_of(&state.now.My[at], &state.now.My[at] + box.nx, moving))
        return false;
    }
  }
  return true;
}

}  // namespace bagnold::shallow

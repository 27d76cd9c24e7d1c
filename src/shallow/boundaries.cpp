// Ghost cells beyond each side, filled before each stage.
#include <algorithm>

#include "shallow/solver.hpp"

namespace bagnold::shallow {
namespace {

constexpr double fewest_steps = 10;  // in a piece of a hydrograph, for its ends not to matter

double interpolate(const std::vector<double>& t, const std::vector<double>& y, double at) {
  if (at <= t.front()) return y.front();
  if (at >= t.back()) return y.back();
  const auto k = static_cast<std::size_t>(std::upper_bound(t.begin(), t.end(), at) - t.begin());
  return y[k - 1] + (y[k] - y[k - 1]) * ((at - t[k - 1]) / (t[k] - t[k - 1]));
}

// Where the cells along a side are: `depth` counts from the side inwards, -1 being the first ghost.
struct Along {
  bool normal_x, low;  // left or right; left or bottom
  int n;               // cells from this side to the other
  template <class Array>
  std::size_t at(const Array& u, int depth, int t) const {
    const int p = low ? depth : n - 1 - depth;
    return normal_x ? u.at(p, t) : u.at(t, p);
  }
  int across(int k) const { return n - 1 - k % n; }  // depth of what a periodic ghost is an image of
};

Along along(const Grid& g, Side side) {
  const bool normal_x = side == Side::left || side == Side::right;
  return {normal_x, side == Side::left || side == Side::bottom, normal_x ? g.nx : g.ny};
}

}  // namespace

void fill_side(const Solver& s, Side side, double time, int lo, int hi, int depth, const Window& u) {
  const Boundary& boundary = s.setup.boundary[static_cast<std::size_t>(side)];
  const Along cells = along(s.setup.grid, side);
  double *normal = cells.normal_x ? u.Mx : u.My, *tangential = cells.normal_x ? u.My : u.Mx;
  const auto each = [&](auto&& source_depth, auto&& fill) {
    for (int k = 0; k < depth; ++k)
      for (int t = lo; t < hi; ++t) fill(cells.at(u, -1 - k, t), cells.at(u, source_depth(k), t));
  };
  switch (boundary.kind) {
    case BoundaryKind::wall:
      return each([&](int k) { return std::min(k, cells.n - 1); },
                  [&](std::size_t to, std::size_t from) {
                    u.D[to] = u.D[from];
                    normal[to] = -normal[from];
                    tangential[to] = tangential[from];
                  });
    case BoundaryKind::outflow:
      return each([](int) { return 0; },
                  [&](std::size_t to, std::size_t from) {
                    u.D[to] = u.D[from];  // nothing comes in
                    normal[to] = cells.low ? std::min(normal[from], 0.0) : std::max(normal[from], 0.0);
                    tangential[to] = tangential[from];
                  });
    case BoundaryKind::periodic:
      return each([&](int k) { return cells.across(k); },
                  [&](std::size_t to, std::size_t from) {
                    u.D[to] = u.D[from];
                    u.Mx[to] = u.Mx[from];
                    u.My[to] = u.My[from];
                  });
    case BoundaryKind::inflow: {
      const Hydrograph& q = boundary.inflow;
      const double h = interpolate(q.t, q.h, time), inwards = interpolate(q.t, q.u, time);
      const double D = h > 0 ? closure_at(s.closure, h, std::abs(inwards)).rho * h : 0;
      return each([](int) { return 0; },
                  [&](std::size_t to, std::size_t) {
                    u.D[to] = D;
                    normal[to] = D * (cells.low ? inwards : -inwards);
                    tangential[to] = 0;
                  });
    }
  }
}

double next_turn(const Solver& s, double time, double dt) {
  double turn = never;
  for (const Boundary& b : s.setup.boundary) {
    if (b.kind != BoundaryKind::inflow) continue;
    const std::vector<double>& t = b.inflow.t;
    const auto next = std::upper_bound(t.begin(), t.end(), time);
    if (next == t.end() || time + dt <= *next) continue;
    const double before = next == t.begin() ? never : *next - *(next - 1),
                 after = next + 1 == t.end() ? never : *(next + 1) - *next;
    if (fewest_steps * dt > std::min(before, after)) turn = std::min(turn, *next);
  }
  return turn;
}

bool more_to_come(const Solver& s, double time) {
  return std::any_of(s.setup.boundary.begin(), s.setup.boundary.end(), [&](const Boundary& b) {
    if (b.kind != BoundaryKind::inflow) return false;
    const Hydrograph& q = b.inflow;
    bool comes = interpolate(q.t, q.h, time) > 0;
    for (std::size_t k = 0; k < q.t.size(); ++k) comes |= q.t[k] > time && q.h[k] > 0;
    return comes;
  });
}

void fill_ghosts(const Solver& s, Conserved& now, double time) {
  const Grid& g = s.setup.grid;
  const Window u = window(g, now);
  fill_side(s, Side::left, time, 0, g.ny, halo, u);
  fill_side(s, Side::right, time, 0, g.ny, halo, u);
  if (!g.two_d()) return;  // corners too, from the ghosts of the left and right
  fill_side(s, Side::bottom, time, -halo, g.nx + halo, halo, u);
  fill_side(s, Side::top, time, -halo, g.nx + halo, halo, u);
}

void fill_bed_ghosts(const Solver& s, std::vector<double>& bed) {
  const Grid& g = s.setup.grid;
  for (const Side side : {Side::left, Side::right, Side::bottom, Side::top}) {
    const BoundaryKind kind = s.setup.boundary[static_cast<std::size_t>(side)].kind;
    const Along cells = along(g, side);
    if (!cells.normal_x && !g.two_d()) break;
    const int lo = cells.normal_x ? 0 : -halo, hi = cells.normal_x ? g.ny : g.nx + halo;
    for (int t = lo; t < hi; ++t)
      for (int k = 0; k < halo; ++k) {
        const auto at = [&](int depth) -> double& { return bed[cells.at(g, depth, t)]; };
        if (kind == BoundaryKind::wall)
          at(-1 - k) = at(std::min(k, cells.n - 1));
        else if (kind == BoundaryKind::periodic)
          at(-1 - k) = at(cells.across(k));
        else  // open sides: the slope goes on
          at(-1 - k) = at(0) - (at(1) - at(0)) * (k + 1);
      }
  }
}

}  // namespace bagnold::shallow

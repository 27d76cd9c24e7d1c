// Ghost cells: two beyond each side, filled before each stage.
#include <algorithm>

#include "shallow/solver.hpp"

namespace bagnold::shallow {
namespace {

double interpolate(const std::vector<double>& t, const std::vector<double>& y, double at) {
  if (at <= t.front()) return y.front();
  if (at >= t.back()) return y.back();
  const auto k = static_cast<std::size_t>(std::upper_bound(t.begin(), t.end(), at) - t.begin());
  return y[k - 1] + (y[k] - y[k - 1]) * ((at - t[k - 1]) / (t[k] - t[k - 1]));
}

// normal_x: the side is left or right; sign: direction into the domain along the normal.
void fill_side(const Solver& s, const Boundary& boundary, bool normal_x, double sign, double time,
               const std::vector<Ghost>& ghosts, Conserved& u) {
  double h = 0, speed = 0;
  if (boundary.kind == BoundaryKind::inflow) {
    h = interpolate(boundary.inflow.t, boundary.inflow.h, time);
    speed = interpolate(boundary.inflow.t, boundary.inflow.u, time) * sign;
  }
  const double D = h > 0 ? closure_at(s.closure, h, std::abs(speed)).rho * h : 0;
  for (const Ghost& g : ghosts) switch (boundary.kind) {
      case BoundaryKind::wall:
        u.D[g.to] = u.D[g.mirror];
        u.Mx[g.to] = normal_x ? -u.Mx[g.mirror] : u.Mx[g.mirror];
        u.My[g.to] = normal_x ? u.My[g.mirror] : -u.My[g.mirror];
        break;
      case BoundaryKind::outflow: {
        u.D[g.to] = u.D[g.edge];
        const double m = normal_x ? u.Mx[g.edge] : u.My[g.edge], out = sign > 0 ? std::min(m, 0.0) : std::max(m, 0.0);
        u.Mx[g.to] = normal_x ? out : u.Mx[g.edge];  // nothing comes in
        u.My[g.to] = normal_x ? u.My[g.edge] : out;
        break;
      }
      case BoundaryKind::periodic:
        u.D[g.to] = u.D[g.across];
        u.Mx[g.to] = u.Mx[g.across];
        u.My[g.to] = u.My[g.across];
        break;
      case BoundaryKind::inflow:
        u.D[g.to] = D;
        u.Mx[g.to] = normal_x ? D * speed : 0;
        u.My[g.to] = normal_x ? 0 : D * speed;
        break;
    }
}

}  // namespace

void list_ghosts(Solver& s) {
  const Grid& g = s.setup.grid;
  auto& [left, right, bottom, top] = s.ghosts;
  for (int j = 0; j < g.ny; ++j)
    for (int k = 0; k < halo; ++k) {
      const int near = std::min(k, g.nx - 1), far = std::max(g.nx - 1 - k, 0);
      left.push_back({g.at(-1 - k, j), g.at(near, j), g.at(0, j), g.at(far, j)});
      right.push_back({g.at(g.nx + k, j), g.at(far, j), g.at(g.nx - 1, j), g.at(near, j)});
    }
  if (!g.two_d()) return;
  for (int i = -halo; i < g.nx + halo; ++i)  // corners too, from the ghosts of the left and right
    for (int k = 0; k < halo; ++k) {
      bottom.push_back({g.at(i, -1 - k), g.at(i, k), g.at(i, 0), g.at(i, g.ny - 1 - k)});
      top.push_back({g.at(i, g.ny + k), g.at(i, g.ny - 1 - k), g.at(i, g.ny - 1), g.at(i, k)});
    }
}

void fill_ghosts(const Solver& s, Conserved& u, double time) {
  const auto& boundary = s.setup.boundary;
  fill_side(s, boundary[0], true, 1, time, s.ghosts[0], u);
  fill_side(s, boundary[1], true, -1, time, s.ghosts[1], u);
  fill_side(s, boundary[2], false, 1, time, s.ghosts[2], u);
  fill_side(s, boundary[3], false, -1, time, s.ghosts[3], u);
}

void fill_bed_ghosts(const Solver& s, std::vector<double>& bed) {
  constexpr std::array<double, 2> beyond = {1, 2};
  for (std::size_t side = 0; side < 4; ++side) {
    const BoundaryKind kind = s.setup.boundary[side].kind;
    for (std::size_t k = 0; k < s.ghosts[side].size(); ++k) {
      const Ghost& g = s.ghosts[side][k];
      const auto inward = static_cast<std::ptrdiff_t>(g.edge) - (k % 2 == 0 ? static_cast<std::ptrdiff_t>(g.to) : 0);
      if (kind == BoundaryKind::wall)
        bed[g.to] = bed[g.mirror];
      else if (kind == BoundaryKind::periodic)
        bed[g.to] = bed[g.across];
      else if (k % 2 == 0) {  // open sides: the slope goes on
        const double edge = bed[g.edge],
                     next = bed[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(g.edge) + inward)];
        bed[g.to] = edge - (next - edge) * beyond[0];
        bed[s.ghosts[side][k + 1].to] = edge - (next - edge) * beyond[1];
      }
    }
  }
}

}  // namespace bagnold::shallow

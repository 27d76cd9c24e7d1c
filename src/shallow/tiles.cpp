// Which tiles have something to do: those with wet cells, and those next to a wet edge.
#include <algorithm>

#include "shallow/solver.hpp"

namespace bagnold::shallow {
namespace {

constexpr int reach = 2;  // cells a front can cross in one step of two stages

// Wet cells of a tile, and whether any lies within reach of its left, right, bottom, top edge.
struct Wetness {
  bool any = false, left = false, right = false, bottom = false, top = false;
};

Wetness wetness(const Solver& s, const State& state, int tile) {
  const Grid& g = s.setup.grid;
  const int i0 = (tile % s.tiles_x) * s.setup.scheme.tile_nx, j0 = (tile / s.tiles_x) * s.setup.scheme.tile_ny;
  const int i1 = std::min(i0 + s.setup.scheme.tile_nx, g.nx), j1 = std::min(j0 + s.setup.scheme.tile_ny, g.ny);
  const double dry = s.closure.dry_density_depth;
  Wetness w;
  for (int j = j0; j < j1; ++j) {
    const double* D = &state.now.D[g.at(0, j)];
    double most = 0;
    for (int i = i0; i < i1; ++i) most = D[i] > most ? D[i] : most;
    if (!(most > dry)) continue;
    w.any = true;
    w.bottom |= j < j0 + reach;
    w.top |= j >= j1 - reach;
    for (int k = 0; k < reach; ++k) {
      w.left |= i0 + k < i1 && D[i0 + k] > dry;
      w.right |= i1 - 1 - k >= i0 && D[i1 - 1 - k] > dry;
    }
  }
  return w;
}

void copy_tile(const Solver& s, int tile, const Conserved& from, Conserved& to) {
  const Grid& g = s.setup.grid;
  const int i0 = (tile % s.tiles_x) * s.setup.scheme.tile_nx, j0 = (tile / s.tiles_x) * s.setup.scheme.tile_ny;
  const int i1 = std::min(i0 + s.setup.scheme.tile_nx, g.nx), j1 = std::min(j0 + s.setup.scheme.tile_ny, g.ny);
  for (int j = j0; j < j1; ++j) {
    const std::size_t at = g.at(i0, j);
    std::copy_n(&from.D[at], i1 - i0, &to.D[at]);
    std::copy_n(&from.Mx[at], i1 - i0, &to.Mx[at]);
    std::copy_n(&from.My[at], i1 - i0, &to.My[at]);
  }
}

// Tiles along an inflow are always active.
bool fed(const Solver& s, int tx, int ty) {
  const auto inflow = [&](Side side) {
    return s.setup.boundary[static_cast<std::size_t>(side)].kind == BoundaryKind::inflow;
  };
  return (tx == 0 && inflow(Side::left)) || (tx == s.tiles_x - 1 && inflow(Side::right)) ||
         (ty == 0 && inflow(Side::bottom)) || (ty == s.tiles_y - 1 && inflow(Side::top));
}

}  // namespace

void find_active_tiles(Solver& s, const State& state) {
  const int nx = s.tiles_x, ny = s.tiles_y;
  std::vector<std::uint8_t>& wanted = s.tile_wanted;
  wanted.assign(static_cast<std::size_t>(nx * ny), 0);
  const auto want = [&](int tx, int ty) {
    wanted[static_cast<std::size_t>(((ty + ny) % ny) * nx + (tx + nx) % nx)] = 1;
  };
  for (const int tile : s.active) {
    const Wetness w = wetness(s, state, tile);
    if (!w.any) continue;
    const int tx = tile % nx, ty = tile / nx;
    for (int dy = w.bottom ? -1 : 0; dy <= (w.top ? 1 : 0); ++dy)
      for (int dx = w.left ? -1 : 0; dx <= (w.right ? 1 : 0); ++dx) want(tx + dx, ty + dy);
  }
  for (int ty = 0; ty < ny; ++ty)
    for (int tx = 0; tx < nx; ++tx)
      if ((tx == 0 || tx == nx - 1 || ty == 0 || ty == ny - 1) && fed(s, tx, ty)) want(tx, ty);
  // A tile that falls asleep keeps its films of mass in every array, so that it can be read and woken as it is.
  for (const int tile : s.active)
    if (!wanted[static_cast<std::size_t>(tile)]) {
      copy_tile(s, tile, state.now, s.predicted);
      copy_tile(s, tile, state.now, s.next);
    }
  s.active.clear();
  for (int tile = 0; tile < nx * ny; ++tile)
    if (wanted[static_cast<std::size_t>(tile)]) s.active.push_back(tile);
}

void refresh(Solver& s, State& state) {
  fill_ghosts(s, state.now, state.time);
  s.predicted = state.now;
  s.next = state.now;
  s.active.clear();
  for (int tile = 0; tile < s.tiles_x * s.tiles_y; ++tile) s.active.push_back(tile);
  find_active_tiles(s, state);
}

}  // namespace bagnold::shallow

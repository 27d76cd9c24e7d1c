// Where there is something to do: of every tile, the box around the cells that are wet or can get wet in one step.
#include <algorithm>

#include "shallow/solver.hpp"

namespace bagnold::shallow {
namespace {

int tile_begin(int cells, int tiles, int t) { return static_cast<int>(static_cast<std::int64_t>(cells) * t / tiles); }

Tile whole_tile(const Solver& s, int tx, int ty) {
  const Grid& g = s.setup.grid;
  const int i0 = tile_begin(g.nx, s.tiles_x, tx), j0 = tile_begin(g.ny, s.tiles_y, ty);
  return {i0, j0, tile_begin(g.nx, s.tiles_x, tx + 1) - i0, tile_begin(g.ny, s.tiles_y, ty + 1) - j0};
}

Tile united(const Tile& a, const Tile& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  const int i0 = std::min(a.i0, b.i0), j0 = std::min(a.j0, b.j0);
  return {i0, j0, std::max(a.i0 + a.nx, b.i0 + b.nx) - i0, std::max(a.j0 + a.ny, b.j0 + b.ny) - j0};
}

bool contains(const Tile& a, const Tile& b) {
  return b.i0 >= a.i0 && b.j0 >= a.j0 && b.i0 + b.nx <= a.i0 + a.nx && b.j0 + b.ny <= a.j0 + a.ny;
}

// What [wet, wet + n), grown by `reach` (a front crosses a cell a stage at most), covers of the tile before (-1), of its own tile (0) or of the tile after (1). The
// first two numbers are the beginning and length of the own tile, the next two those of the other.
struct Span {
  int begin, n;
};
Span covered(Span wet, Span own, Span other, int which) {
  const int before = std::max(0, own.begin - (wet.begin - reach)),
            after = std::max(0, (wet.begin + wet.n + reach) - (own.begin + own.n));
  if (which < 0) return {other.begin + other.n - std::min(before, other.n), std::min(before, other.n)};
  if (which > 0) return {other.begin, std::min(after, other.n)};
  const int begin = std::max(own.begin, wet.begin - reach);
  return {begin, std::min(own.begin + own.n, wet.begin + wet.n + reach) - begin};
}

// Index of the neighbour of tile `t` among `count`, across a periodic boundary too; -1: there is none.
int neighbour(int t, int step, int count, bool periodic) {
  const int n = t + step;
  if (n >= 0 && n < count) return n;
  return periodic ? (n + count) % count : -1;
}

// Boxes of all tiles from the wet boxes of the active ones.
void grow(const Solver& s, const std::vector<Tile>& wet, std::vector<Tile>& boxes) {
  const bool wrap_x = s.setup.boundary[0].kind == BoundaryKind::periodic,
             wrap_y = s.setup.boundary[2].kind == BoundaryKind::periodic;
  for (const int index : s.active) {
    const Tile& w = wet[static_cast<std::size_t>(index)];
    if (w.empty()) continue;
    const int tx = index % s.tiles_x, ty = index / s.tiles_x;
    const Tile own = whole_tile(s, tx, ty);
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int ox = neighbour(tx, dx, s.tiles_x, wrap_x), oy = neighbour(ty, dy, s.tiles_y, wrap_y);
        if (ox < 0 || oy < 0) continue;
        const Tile other = whole_tile(s, ox, oy);
        const Span x = covered({w.i0, w.nx}, {own.i0, own.nx}, {other.i0, other.nx}, dx),
                   y = covered({w.j0, w.ny}, {own.j0, own.ny}, {other.j0, other.ny}, dy);
        Tile& box = boxes[static_cast<std::size_t>(oy * s.tiles_x + ox)];
        box = united(box, {x.begin, y.begin, x.n, y.n});
      }
  }
}

// Along an inflow something may come in at any time.
void feed(const Solver& s, std::vector<Tile>& boxes) {
  const auto inflow = [&](Side side) {
    return s.setup.boundary[static_cast<std::size_t>(side)].kind == BoundaryKind::inflow;
  };
  for (int ty = 0; ty < s.tiles_y; ++ty)
    for (int tx = 0; tx < s.tiles_x; ++tx) {
      const Tile own = whole_tile(s, tx, ty);
      const int nx = std::min(reach, own.nx), ny = std::min(reach, own.ny);
      Tile& box = boxes[static_cast<std::size_t>(ty * s.tiles_x + tx)];
      if (tx == 0 && inflow(Side::left)) box = united(box, {own.i0, own.j0, nx, own.ny});
      if (tx == s.tiles_x - 1 && inflow(Side::right)) box = united(box, {own.i0 + own.nx - nx, own.j0, nx, own.ny});
      if (ty == 0 && inflow(Side::bottom)) box = united(box, {own.i0, own.j0, own.nx, ny});
      if (ty == s.tiles_y - 1 && inflow(Side::top)) box = united(box, {own.i0, own.j0 + own.ny - ny, own.nx, ny});
    }
}

void copy_box(const Solver& s, const Tile& box, const Conserved& from, Conserved& to) {
  for (int j = box.j0; j < box.j0 + box.ny; ++j) {
    const std::size_t at = s.setup.grid.at(box.i0, j);
    std::copy_n(&from.D[at], box.nx, &to.D[at]);
    std::copy_n(&from.Mx[at], box.nx, &to.Mx[at]);
    std::copy_n(&from.My[at], box.nx, &to.My[at]);
  }
}

}  // namespace

Tile wet_box(const Solver& s, const Conserved& u, const Tile& box) {
  const double dry = s.closure.dry_density_depth;
  int left = box.i0 + box.nx, right = box.i0, low = box.j0 + box.ny, high = box.j0;  // [left, right) x [low, high)
  for (int j = box.j0; j < box.j0 + box.ny; ++j) {
    const double* D = &u.D[s.setup.grid.at(0, j)];
    double most = 0;
    for (int i = box.i0; i < box.i0 + box.nx; ++i) most = D[i] > most ? D[i] : most;
    if (!(most > dry)) continue;
    low = std::min(low, j);
    high = j + 1;
    for (int i = box.i0; i < left; ++i)
      if (D[i] > dry) left = i;
    for (int i = box.i0 + box.nx - 1; i >= right; --i)
      if (D[i] > dry) right = i + 1;
  }
  return {left, low, right - left, high - low};
}

void find_active_tiles(Solver& s, const State& state) {
  std::vector<Tile>& grown = s.grown_boxes;
  grown.assign(s.boxes.size(), {});
  grow(s, s.wet_boxes, grown);
  feed(s, grown);
  // Cells that fall asleep keep their films of mass in both arrays, so that they can be read and woken as they are.
  for (const int tile : s.active) {
    const auto t = static_cast<std::size_t>(tile);
    if (contains(grown[t], s.boxes[t])) continue;
    copy_box(s, s.boxes[t], state.now, s.next);
  }
  s.boxes.swap(grown);
  s.active.clear();
  for (std::size_t tile = 0; tile < s.boxes.size(); ++tile)
    if (!s.boxes[tile].empty()) s.active.push_back(static_cast<int>(tile));
}

void refresh(Solver& s, State& state) {
  fill_ghosts(s, state.now, state.time);
  s.next = state.now;
  s.active.clear();
  s.boxes.clear();
  s.wet_boxes.clear();
  for (int tile = 0; tile < s.tiles_x * s.tiles_y; ++tile) {
    s.boxes.push_back(whole_tile(s, tile % s.tiles_x, tile / s.tiles_x));
    s.wet_boxes.push_back(wet_box(s, state.now, s.boxes.back()));
    s.active.push_back(tile);
  }
  find_active_tiles(s, state);
}

}  // namespace bagnold::shallow

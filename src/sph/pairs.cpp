#include "sph/pairs.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/simd.hpp"
#include "core/vec3.hpp"
#include "neighbours/cell_grid.hpp"

namespace bagnold::sph {
namespace {

constexpr double least_skin = 0.05, most_skin = 0.2;  // over h

template <class T>
void permute(std::vector<T>& a, const std::vector<std::int32_t>& order) {
  std::vector<T> sorted(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) sorted[i] = a[static_cast<std::size_t>(order[i])];
  a = std::move(sorted);
}

void require_finite(const std::vector<Vec3>& x, const Particles& p) {
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!std::isfinite(norm2(x[i])))
      throw NumericalError("sph: the position of particle " + std::to_string(p.id[i]) + " is not a number");
}

Vec3 point(const Field& x, std::size_t i, int dim) {
  return dim == 2 ? Vec3{x[0][i], 0, x[1][i]} : Vec3{x[0][i], x[1][i], x[2][i]};
}

void sort_particles(Particles& p, const Model& model, double cutoff) {
  const auto n = static_cast<std::size_t>(p.size());
  std::vector<Vec3> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = point(p.x, i, model.dim);
  require_finite(x, p);
  neighbours::CellGrid grid;
  sort_into_cells(grid, Box{}, x, cutoff);
  for (Field* f : {&p.x, &p.v, &p.rate})
    for (int k = 0; k < model.dim; ++k) permute((*f)[static_cast<std::size_t>(k)], grid.order);
  for (auto* a : {&p.rho, &p.mass, &p.root}) permute(*a, grid.order);
  permute(p.id, grid.order);
}

// Points in the order of the cells, so that those of neighbouring cells lie side by side.
struct Sorted {
  neighbours::CellGrid grid;
  std::array<std::vector<double>, 3> x;
  std::vector<std::uint32_t> who;
  std::vector<std::int32_t> slot;  // of every point
};

Sorted sort_points(const std::vector<Vec3>& x, double cutoff) {
  Sorted s;
  sort_into_cells(s.grid, Box{}, x, cutoff);
  const std::size_t room = x.size() + Pack::lanes;  // packs are read whole
  for (auto& c : s.x) c.resize(room, 1e30);
  s.who.resize(room);
  s.slot.resize(x.size());
  parallel_for(static_cast<std::int64_t>(x.size()), [&](std::int64_t k) {
    const auto q = static_cast<std::size_t>(k), i = static_cast<std::size_t>(s.grid.order[q]);
    for (int d = 0; d < 3; ++d) s.x[static_cast<std::size_t>(d)][q] = x[i][d];
    s.who[q] = static_cast<std::uint32_t>(i);
    s.slot[i] = static_cast<std::int32_t>(q);
  });
  return s;
}

// Calls f(first, last) for the slots of the cells around the one of point i, row by row.
template <class F>
void for_each_row(const neighbours::CellGrid& grid, std::size_t i, F&& f) {
  const auto [n0, n1, n2] = grid.count;
  const int home = grid.cell_of[i], c0 = home / (n1 * n2), c1 = home / n2 % n1, c2 = home % n2;
  for (int a = std::max(c0 - 1, 0); a <= std::min(c0 + 1, n0 - 1); ++a)
    for (int b = std::max(c1 - 1, 0); b <= std::min(c1 + 1, n1 - 1); ++b) {
      const auto row = static_cast<std::size_t>((a * n1 + b) * n2);
      f(grid.cell_begin[row + static_cast<std::size_t>(std::max(c2 - 1, 0))],
        grid.cell_begin[row + static_cast<std::size_t>(std::min(c2 + 1, n2 - 1)) + 1]);
    }
}

// Neighbour lists of one block of particles, one after the other; the vector has room to spare.
struct Found {
  std::vector<std::uint32_t> who;
  std::size_t count = 0;
};

// Appends the neighbours of point i, padded with `dummy` to whole packs.
void append_neighbours(const Sorted& s, std::size_t i, double cutoff, std::uint32_t dummy, Found& found) {
  const std::int32_t self = s.slot[i];
  const auto at = static_cast<std::size_t>(self);
  const Pack x = s.x[0][at], y = s.x[1][at], z = s.x[2][at], most = cutoff * cutoff;
  for_each_row(s.grid, i, [&](std::int32_t first, std::int32_t last) {
    for (std::int32_t q = first; q < last; q += Pack::lanes) {
      const auto k = static_cast<std::size_t>(q);
      const Pack dx = x - Pack::load_unaligned(&s.x[0][k]), dy = y - Pack::load_unaligned(&s.x[1][k]),
                 dz = z - Pack::load_unaligned(&s.x[2][k]);
      std::uint32_t near = to_integer(dx * dx + dy * dy + dz * dz < most);
      if (last - q < Pack::lanes) near &= (1u << (last - q)) - 1;
      if (self >= q && self - q < Pack::lanes) near &= ~(1u << (self - q));
      if (found.who.size() < found.count + 2 * Pack::lanes) found.who.resize(2 * found.count + 8192);
      found.count += static_cast<std::size_t>(compress(near, &s.who[k], &found.who[found.count]));
    }
  });
  while (found.count % Pack::lanes != 0) found.who[found.count++] = dummy;
}

}  // namespace

bool outdated(const Pairs& pairs, const Particles& p, int dim, double lead) {
  if (pairs.offset.empty()) return true;
  const double limit = 0.25 * p.skin * p.skin;
  constexpr std::int64_t block = 1024;
  std::vector<std::uint8_t> moved(static_cast<std::size_t>((p.size() + block - 1) / block));
  parallel_blocks(p.size(), block, [&](std::int64_t begin, std::int64_t end) {
    std::array<double, block> r2{};
    const auto first = static_cast<std::size_t>(begin), count = static_cast<std::size_t>(end - begin);
    for (std::size_t k = 0; k < static_cast<std::size_t>(dim); ++k) {
      const double *x = p.x[k].data() + first, *built = p.x_built[k].data() + first, *v = p.v[k].data() + first;
      for (std::size_t i = 0; i < count; ++i) {
        const double d = std::abs(x[i] - built[i]) + lead * std::abs(v[i]);
        r2[i] += d * d;
      }
    }
    std::int64_t far = 0;
    for (std::size_t i = 0; i < count; ++i) far += !(r2[i] <= limit);  // also for NaN
    moved[static_cast<std::size_t>(begin / block)] = far > 0;
  });
  return std::find(moved.begin(), moved.end(), 1) != moved.end();
}

void rebuild(Pairs& pairs, Particles& p, const Model& model, double travel) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(model.dim); ++k)
    if (const double length = model.period[k]; length > 0)
      for (double& x : p.x[k]) {
        x -= length * std::floor(x / length);
        if (x >= length) x = 0;  // floor of a tiny negative rounds up
      }
  p.skin = std::clamp(2 * travel, least_skin * model.h(), most_skin * model.h());
  sort_particles(p, model, 2 * model.h() + p.skin);
  p.x_built = p.x;
  relist(pairs, p, model);
}

void relist(Pairs& pairs, const Particles& p, const Model& model) {
  const double cutoff = 2 * model.h() + p.skin;
  Particles built;
  built.x = p.x_built;
  built.mass = p.mass;
  pairs.images = make_images(model, built, cutoff);
  const auto n = static_cast<std::size_t>(p.size()), m = n + static_cast<std::size_t>(pairs.images.size());
  std::vector<Vec3> x(m);
  for (std::size_t i = 0; i < n; ++i) x[i] = point(built.x, i, model.dim);
  for (std::size_t i = n; i < m; ++i) {
    Vec3& image = x[i];
    for (std::size_t k = 0; k < static_cast<std::size_t>(model.dim); ++k)
      image[k == 1 && model.dim == 2 ? 2 : static_cast<int>(k)] =
          pairs.images.R[i - n][k] * built.x[k][static_cast<std::size_t>(pairs.images.parent[i - n])] +
          pairs.images.shift[i - n][k];
  }
  const Sorted sorted = sort_points(x, cutoff);
  constexpr std::int64_t block = 256;
  std::vector<Found> found(static_cast<std::size_t>((p.size() + block - 1) / block));
  pairs.offset.assign(n + 1, 0);
  parallel_blocks(p.size(), block, [&](std::int64_t begin, std::int64_t end) {
    auto& mine = found[static_cast<std::size_t>(begin / block)];
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      const std::size_t before = mine.count;
      append_neighbours(sorted, i, cutoff, static_cast<std::uint32_t>(m), mine);
      pairs.offset[i + 1] = static_cast<std::int64_t>(mine.count - before);
    }
  });
  for (std::size_t i = 0; i < n; ++i) pairs.offset[i + 1] += pairs.offset[i];
  pairs.index.resize(static_cast<std::size_t>(pairs.offset[n]));
  parallel_blocks(p.size(), block, [&](std::int64_t begin, std::int64_t) {
    const Found& mine = found[static_cast<std::size_t>(begin / block)];
    std::copy_n(mine.who.begin(), mine.count, pairs.index.begin() + pairs.offset[static_cast<std::size_t>(begin)]);
  });
}

}  // namespace bagnold::sph

#include "sph/pairs.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/octet.hpp"
#include "core/parallel.hpp"
#include "core/vec3.hpp"
#include "neighbours/cell_grid.hpp"

namespace bagnold::sph {
namespace {

constexpr double skin_over_h = 0.2;

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

// Calls f(j) for all points j in the cells around the one of i.
template <class F>
void for_each_near(const neighbours::CellGrid& grid, std::size_t i, F&& f) {
  const auto [n0, n1, n2] = grid.count;
  const int home = grid.cell_of[i], c0 = home / (n1 * n2), c1 = home / n2 % n1, c2 = home % n2;
  for (int a = std::max(c0 - 1, 0); a <= std::min(c0 + 1, n0 - 1); ++a)
    for (int b = std::max(c1 - 1, 0); b <= std::min(c1 + 1, n1 - 1); ++b) {
      const auto row = static_cast<std::size_t>((a * n1 + b) * n2);
      const auto first = grid.cell_begin[row + static_cast<std::size_t>(std::max(c2 - 1, 0))];
      const auto last = grid.cell_begin[row + static_cast<std::size_t>(std::min(c2 + 1, n2 - 1)) + 1];
      for (auto q = first; q < last; ++q) f(grid.order[static_cast<std::size_t>(q)]);
    }
}

}  // namespace

bool outdated(const Pairs& pairs, const Particles& p, int dim, double lead) {
  if (pairs.offset.empty()) return true;
  const double limit = 0.25 * pairs.skin * pairs.skin;
  constexpr std::int64_t block = 4096;
  std::vector<std::uint8_t> moved(static_cast<std::size_t>((p.size() + block - 1) / block));
  parallel_blocks(p.size(), block, [&](std::int64_t begin, std::int64_t end) {
    double most = 0;
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      double r2 = 0;
      for (std::size_t k = 0; k < static_cast<std::size_t>(dim); ++k) {
        const double d = std::abs(p.x[k][i] - p.x_built[k][i]) + lead * std::abs(p.v[k][i]);
        r2 += d * d;
      }
      most = std::max(most, r2);
    }
    moved[static_cast<std::size_t>(begin / block)] = !(most <= limit);
  });
  return std::find(moved.begin(), moved.end(), 1) != moved.end();
}

void rebuild(Pairs& pairs, Particles& p, const Model& model) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(model.dim); ++k)
    if (const double length = model.period[k]; length > 0)
      for (double& x : p.x[k]) {
        x -= length * std::floor(x / length);
        if (x >= length) x = 0;  // floor of a tiny negative rounds up
      }
  sort_particles(p, model, (2 + skin_over_h) * model.h());
  p.x_built = p.x;
  relist(pairs, p, model);
}

void relist(Pairs& pairs, const Particles& p, const Model& model) {
  pairs.skin = skin_over_h * model.h();
  const double cutoff = 2 * model.h() + pairs.skin;
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
  neighbours::CellGrid grid;
  sort_into_cells(grid, Box{}, x, cutoff);
  pairs.offset.assign(n + 1, 0);
  const auto near = [&](std::size_t i, std::int32_t j) {
    return static_cast<std::size_t>(j) != i && norm2(x[i] - x[static_cast<std::size_t>(j)]) < cutoff * cutoff;
  };
  parallel_for(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    std::int64_t count = 0;
    for_each_near(grid, i, [&](std::int32_t j) { count += near(i, j); });
    pairs.offset[i + 1] = (count + octet_size - 1) / octet_size * octet_size;
  });
  for (std::size_t i = 0; i < n; ++i) pairs.offset[i + 1] += pairs.offset[i];
  pairs.index.resize(static_cast<std::size_t>(pairs.offset[n]));
  parallel_for(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    auto to = static_cast<std::size_t>(pairs.offset[i]);
    for_each_near(grid, i, [&](std::int32_t j) {
      if (near(i, j)) pairs.index[to++] = j;
    });
    while (to < static_cast<std::size_t>(pairs.offset[i + 1])) pairs.index[to++] = static_cast<std::int32_t>(m);
  });
}

}  // namespace bagnold::sph

#include "cg/grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cg/carried.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

namespace bagnold::cg {
namespace {

struct Range3 {
  std::array<std::int64_t, 3> begin{}, end{};
  bool empty() const { return begin[0] >= end[0] || begin[1] >= end[1] || begin[2] >= end[2]; }
};

// One slab of the grid, seen by one thread.
template <class Kernel>
struct Target {
  const Grid& grid;
  const Kernel& kernel;
  const Box& box;
  std::vector<Row>& sums;
  std::int64_t k_begin, k_end;
  int dimension;
  double support, weight;  // weight = 1/(extent of the averaged directions)
};

// Nodes in [lo, hi], clipped to the slab.
template <class Kernel>
Range3 nodes_within(const Target<Kernel>& t, const Vec3& lo, const Vec3& hi) {
  Range3 r;
  for (int a = 0; a < 3; ++a) {
    const auto d = static_cast<std::size_t>(a);
    const std::int64_t first = a == 2 ? t.k_begin : 0, last = a == 2 ? t.k_end : t.grid.count[d];
    if (!t.grid.resolved[d]) {
      r.begin[d] = 0;
      r.end[d] = 1;
      continue;
    }
    const auto index = [&](double x) {  // clamped before the conversion: a ray reaches to infinity
      return std::clamp((x - t.grid.origin[a]) / t.grid.spacing[a], static_cast<double>(first) - 1,
                        static_cast<double>(last) + 1);
    };
    r.begin[d] = std::max(first, static_cast<std::int64_t>(std::ceil(index(lo[a]))));
    r.end[d] = std::min(last, static_cast<std::int64_t>(std::floor(index(hi[a]))) + 1);
  }
  return r;
}

// f(range, shift) for every periodic image of the box [lo, hi] whose neighbourhood meets the slab.
template <class Kernel, class F>
void for_each_image(const Target<Kernel>& t, Vec3 lo, Vec3 hi, F&& f) {
  std::array<std::int64_t, 3> first{}, last{};
  for (int a = 0; a < 3; ++a) {
    const auto d = static_cast<std::size_t>(a);
    lo[a] -= t.support;
    hi[a] += t.support;
    if (!t.grid.resolved[d] || !t.box.periodic[d]) continue;
    const double L = t.box.length[a],
                 end = t.grid.origin[a] + static_cast<double>(t.grid.count[d] - 1) * t.grid.spacing[a];
    first[d] = static_cast<std::int64_t>(std::ceil((t.grid.origin[a] - hi[a]) / L));
    last[d] = static_cast<std::int64_t>(std::floor((end - lo[a]) / L));
  }
  for (std::int64_t k = first[2]; k <= last[2]; ++k)
    for (std::int64_t j = first[1]; j <= last[1]; ++j)
      for (std::int64_t i = first[0]; i <= last[0]; ++i) {
        const Vec3 shift{static_cast<double>(i) * t.box.length.x, static_cast<double>(j) * t.box.length.y,
                         static_cast<double>(k) * t.box.length.z};
        const Range3 range = nodes_within(t, lo + shift, hi + shift);
        if (!range.empty()) f(range, shift);
      }
}

// f(row, separation) for every node of the range; the separation of averaged directions is zero.
template <class Kernel, class F>
void for_each_node(const Target<Kernel>& t, const Range3& range, const Vec3& from, F&& f) {
  const Grid& g = t.grid;
  for (std::int64_t k = range.begin[2]; k < range.end[2]; ++k)
    for (std::int64_t j = range.begin[1]; j < range.end[1]; ++j)
      for (std::int64_t i = range.begin[0]; i < range.end[0]; ++i) {
        const std::int64_t n = i + g.count[0] * (j + g.count[1] * k);
        Vec3 d = g.node(n) - from;
        if (!g.resolved[0]) d.x = 0;
        if (!g.resolved[1]) d.y = 0;
        f(t.sums[static_cast<std::size_t>(n)], d);
      }
}

template <class Kernel>
void carry(const Target<Kernel>& t, const Vec3& x, const std::array<double, kCarried>& q) {
  for_each_image(t, x, x, [&](const Range3& range, const Vec3& shift) {
    for_each_node(t, range, x + shift, [&](Row& row, const Vec3& d) {
      const double w = t.weight * t.kernel.density(norm2(d), t.dimension);
      for (std::size_t c = 0; c < kCarried; ++c) row[c] += w * q[c];
    });
  });
}

// Adds -f_a r_b times the mean of W over the segment from `start` to `start - r` (eq. 32).
template <class Kernel>
void spread(const Target<Kernel>& t, Channel channel, const Vec3& start, const Vec3& r, const Vec3& f) {
  const Tensor3 fr = outer(f, r);
  Vec3 along = -r;  // projected on the resolved directions
  for (int a = 0; a < 3; ++a)
    if (!t.grid.resolved[static_cast<std::size_t>(a)]) along[a] = 0;
  const double length = norm(along);
  const Vec3 end = start - r;
  const Vec3 lo{std::min(start.x, end.x), std::min(start.y, end.y), std::min(start.z, end.z)};
  const Vec3 hi{std::max(start.x, end.x), std::max(start.y, end.y), std::max(start.z, end.z)};
  const bool is_short = length < 1e-3 * t.support;  // there the difference of integrals would cancel
  for_each_image(t, lo, hi, [&](const Range3& range, const Vec3& shift) {
    for_each_node(t, range, start + shift, [&](Row& row, const Vec3& d) {
      double mean = 0;
      if (is_short) {  // three-point Gauss rule
        mean = (8 * t.kernel.density(norm2(d - 0.5 * along), t.dimension) +
                5 * t.kernel.density(norm2(d - (0.5 - std::sqrt(0.15)) * along), t.dimension) +
                5 * t.kernel.density(norm2(d - (0.5 + std::sqrt(0.15)) * along), t.dimension)) /
               18;
      } else {
        const double s = dot(d, along) / length;
        mean = t.kernel.line(std::max(norm2(d) - s * s, 0.0), -s, length - s, t.dimension) / length;
      }
      const double w = -t.weight * mean;
      for (std::size_t c = 0; c < 9; ++c) row[channel + c] += w * fr.v[c];
    });
  });
}

// Adds -f_a times the integral of W over the ray from `start` straight down, to the components sigma_az.
template <class Kernel>
void spread_down(const Target<Kernel>& t, const Vec3& start, const Vec3& f) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Vec3 low{start.x, start.y, t.grid.origin.z - t.support};
  for_each_image(t, low, start, [&](Range3 range, const Vec3& shift) {
    for_each_node(t, range, start + shift, [&](Row& row, const Vec3& d) {
      const double w = -t.weight * t.kernel.line(d.x * d.x + d.y * d.y, d.z, infinity, t.dimension);
      for (int a = 0; a < 3; ++a) row[kBase + static_cast<std::size_t>(3 * a + 2)] += w * f[a];
    });
  });
}

template <class Kernel>
void add_slab(const Target<Kernel>& t, const Snapshot& s, const std::vector<std::array<double, 6>>& nn) {
  std::array<double, kCarried> q;
  for (std::size_t i = 0; i < static_cast<std::size_t>(s.flowing); ++i) {
    carried_by_grain(q.data(), s, i, nn[i].data());
    carry(t, s.x[i], q);
  }
  for (const dem::Contact& c : s.contacts) {
    const Vec3 x = s.x[static_cast<std::size_t>(c.i)];
    if (!touches_base(s, c)) {
      spread(t, kContact, x, c.branch, c.force);
    } else {
      const Vec3 arm = arm_from_contact(s, c);
      spread(t, kBase, x, arm, c.force);
      spread_down(t, x - arm, c.force);
    }
  }
}

}  // namespace

Grid make_grid(const Box& box, std::array<bool, 3> resolved, double z_min, double z_max, double spacing) {
  Grid g;
  g.resolved = resolved;
  g.origin = {box.origin.x, box.origin.y, z_min};
  for (int a = 0; a < 3; ++a) {
    const auto d = static_cast<std::size_t>(a);
    if (!resolved[d]) continue;
    const bool wraps = box.periodic[d] && a != 2;
    const double extent = a == 2 ? z_max - z_min : box.length[a];
    const auto steps = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(extent / spacing - 1e-9)));
    g.spacing[a] = extent / static_cast<double>(steps);
    g.count[d] = wraps ? steps : steps + 1;
  }
  return g;
}

void add_snapshot(std::vector<Row>& sums, const Grid& grid, const laws::CgKernels::Any& kernel, const Snapshot& s) {
  if (!grid.resolved[2]) throw UnphysicalError("grid", "a coarse-graining grid has to resolve z");
  sums.resize(static_cast<std::size_t>(grid.size()));
  std::vector<std::array<double, 6>> nn(static_cast<std::size_t>(s.flowing), std::array<double, 6>{});
  for (const dem::Contact& c : s.contacts) {
    add_normal(nn[static_cast<std::size_t>(c.i)].data(), c.normal);
    if (!touches_base(s, c)) add_normal(nn[static_cast<std::size_t>(c.j)].data(), c.normal);
  }
  double averaged = 1;
  for (int a = 0; a < 3; ++a)
    if (!grid.resolved[static_cast<std::size_t>(a)]) averaged *= s.box.length[a];
  std::visit(
      [&](const auto& k) {
        using Kernel = std::decay_t<decltype(k)>;
        const int dimension = grid.dimension();
        // Slabs own their nodes, and every slab adds grains and contacts in the same order.
        parallel_blocks(
            grid.count[2], std::max<std::int64_t>(1, grid.count[2] / 32), [&](std::int64_t b, std::int64_t e) {
              add_slab(Target<Kernel>{grid, k, s.box, sums, b, e, dimension, k.support(dimension), 1 / averaged}, s,
                       nn);
            });
      },
      kernel);
}

std::vector<Gradient> gradients(const std::vector<Row>& rows, const Grid& g, const Box& box) {
  std::vector<Gradient> out(rows.size());
  const std::array<std::int64_t, 3> stride{1, g.count[0], g.count[0] * g.count[1]};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t count = g.count[a];
    const double h = g.spacing[static_cast<int>(a)];
    if (!g.resolved[a] || count < 3) continue;
    const bool wraps =
        box.periodic[a] && std::abs(static_cast<double>(count) * h - box.length[static_cast<int>(a)]) < 1e-9 * h;
    for (std::size_t n = 0; n < rows.size(); ++n) {
      const std::int64_t i = static_cast<std::int64_t>(n) / stride[a] % count;
      const auto at = [&](std::int64_t offset, std::size_t c) {
        const std::int64_t to = wraps ? ((i + offset) % count + count) % count : i + offset;
        return rows[static_cast<std::size_t>(static_cast<std::int64_t>(n) + (to - i) * stride[a])][c];
      };
      for (std::size_t c = 0; c < 4; ++c) {
        double& d = out[n].d[a][c];
        if (wraps || (i >= 2 && i + 2 < count))
          d = (8 * (at(1, c) - at(-1, c)) - (at(2, c) - at(-2, c))) / (12 * h);
        else if (i == 0)
          d = (-3 * at(0, c) + 4 * at(1, c) - at(2, c)) / (2 * h);
        else if (i == count - 1)
          d = (3 * at(0, c) - 4 * at(-1, c) + at(-2, c)) / (2 * h);
        else
          d = (at(1, c) - at(-1, c)) / (2 * h);
      }
    }
  }
  return out;
}

}  // namespace bagnold::cg

#include "sph/observe.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.hpp"
#include "sph/constitutive.hpp"

namespace bagnold::sph {

double kinetic_energy(const State& state, const Model& model) {
  const Particles& p = state.particles;
  return parallel_sum<double>(p.size(), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    double v2 = 0;
    for (std::size_t d = 0; d < static_cast<std::size_t>(model.dim); ++d) v2 += p.v[d][i] * p.v[d][i];
    return 0.5 * p.mass[i] * v2;
  });
}

std::array<double, 3> momentum(const State& state, const Model& model) {
  const Particles& p = state.particles;
  std::array<double, 3> sum{};
  for (std::size_t d = 0; d < static_cast<std::size_t>(model.dim); ++d)
    sum[d] = parallel_sum<double>(p.size(), [&](std::int64_t k) {
      return p.mass[static_cast<std::size_t>(k)] * p.v[d][static_cast<std::size_t>(k)];
    });
  return sum;
}

double total_mass(const State& state) {
  return parallel_sum<double>(state.particles.size(),
                              [&](std::int64_t k) { return state.particles.mass[static_cast<std::size_t>(k)]; });
}

double max_inertial_number(const State& state, const Work& w, const Model& model) {
  constexpr double inside = 0.9;
  double most = 0;
  for (std::size_t i = 0; i < w.coverage.size(); ++i)
    if (w.coverage[i] > inside && state.particles.root[i] > 0)
      most = std::max(most, inertial_number(model, w.shear_rate[i], state.particles.root[i]));
  return most;
}

namespace {

double horizontal_distance(const Particles& p, std::size_t i, std::size_t up) {
  double r2 = 0;
  for (std::size_t d = 0; d < up; ++d) r2 += p.x[d][i] * p.x[d][i];
  return std::sqrt(r2);
}

double layer_edge(const Particles& p, const Model& model, double reach) {
  const bool rings = model.axisymmetric || model.dim == 3;
  const double width = 2 * model.spacing, least = std::max(model.material.grain_diameter, 0.5 * model.spacing);
  std::vector<double> depth(static_cast<std::size_t>(reach / width) + 2, 0.0);
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    const auto ring =
        static_cast<std::size_t>(horizontal_distance(p, i, static_cast<std::size_t>(model.vertical())) / width);
    const double middle = (static_cast<double>(ring) + 0.5) * width, area = (rings ? 2 * M_PI * middle : 2) * width;
    depth[ring] += p.mass[i] / (model.phi_max() * model.grains().grain_density * area);
  }
  std::size_t ring = 0;
  while (depth[ring] >= least) ++ring;  // the last one is empty
  if (ring == 0) return 0;
  return width * (static_cast<double>(ring) - 0.5 + (depth[ring - 1] - least) / (depth[ring - 1] - depth[ring]));
}

}  // namespace

Front find_front(const State& state, const Work& w, const Model& model) {
  constexpr double link = 1.6;  // over dp
  const Particles& p = state.particles;
  const auto n = static_cast<std::size_t>(p.size());
  const auto up = static_cast<std::size_t>(model.vertical());
  std::vector<std::int32_t> group(n), size(n, 1);
  std::iota(group.begin(), group.end(), 0);
  const auto root = [&](std::int32_t i) {
    while (group[static_cast<std::size_t>(i)] != i)
      i = group[static_cast<std::size_t>(i)] = group[static_cast<std::size_t>(group[static_cast<std::size_t>(i)])];
    return i;
  };
  const double near = link * link * model.spacing * model.spacing;
  for (std::size_t i = 0; i < n; ++i)
    for (auto q = w.pairs.offset[i]; q < w.pairs.offset[i + 1]; ++q) {
      const auto j = static_cast<std::size_t>(w.pairs.index[static_cast<std::size_t>(q)]);
      if (j >= i) continue;
      double r2 = 0;
      for (std::size_t d = 0; d < static_cast<std::size_t>(model.dim); ++d)
        r2 += (p.x[d][i] - p.x[d][j]) * (p.x[d][i] - p.x[d][j]);
      if (r2 > near) continue;
      auto a = root(static_cast<std::int32_t>(i)), b = root(static_cast<std::int32_t>(j));
      if (a == b) continue;
      if (size[static_cast<std::size_t>(a)] < size[static_cast<std::size_t>(b)]) std::swap(a, b);
      group[static_cast<std::size_t>(b)] = a;
      size[static_cast<std::size_t>(a)] += size[static_cast<std::size_t>(b)];
    }
  std::int32_t largest = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (size[static_cast<std::size_t>(root(static_cast<std::int32_t>(i)))] > size[static_cast<std::size_t>(largest)])
      largest = root(static_cast<std::int32_t>(i));
  Front front;
  for (std::size_t i = 0; i < n; ++i) {
    const double reach = horizontal_distance(p, i, up) + 0.5 * model.spacing;
    front.raw = std::max(front.raw, reach);
    if (root(static_cast<std::int32_t>(i)) != largest) continue;
    front.connected = std::max(front.connected, reach);
    front.height = std::max(front.height, p.x[up][i] + 0.5 * model.spacing);
  }
  front.layer = layer_edge(p, model, front.raw);
  return front;
}

MassQuantiles radii(const State& state, const Model& model) {
  const Particles& p = state.particles;
  std::vector<std::pair<double, double>> by_radius;
  for (std::size_t i = 0; i < p.mass.size(); ++i)
    by_radius.emplace_back(horizontal_distance(p, i, static_cast<std::size_t>(model.vertical())), p.mass[i]);
  return MassQuantiles(std::move(by_radius));
}

}  // namespace bagnold::sph

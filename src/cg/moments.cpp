#include "cg/moments.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/error.hpp"

namespace bagnold::cg {
namespace {

constexpr std::int64_t bins_per_support = 64;
constexpr std::int64_t most_bins = 1 << 16;

// What turns moments into values: for a node in the middle of an expansion at a distance of (m - 1/2) bins, the
// derivatives -1 ... terms of the kernel (index shifted by one), or their means over the averaging interval.
struct Table {
  std::int64_t reach;  // bins on either side of a node
  int terms;
  std::vector<double> value;  // [2 reach][terms + 2]
  const double* row(std::int64_t offset) const {
    return value.data() + static_cast<std::size_t>((offset + reach) * (terms + 2));
  }
};

template <class Kernel>
Table make_table(const Kernel& kernel, const Lattice& lattice, bool averaged) {
  const double h = lattice.bin(), half = lattice.spacing / 2;
  const auto extra = averaged ? lattice.bins_per_node / 2 : 0;
  Table t{static_cast<std::int64_t>(std::ceil(kernel.support(1) / h - 1e-9)) + extra, Kernel::expansion_terms, {}};
  for (std::int64_t m = -t.reach; m < t.reach; ++m) {
    const double z = -(static_cast<double>(m) + 0.5) * h;  // node minus centre of the bin m bins above it
    for (int n = -1; n <= t.terms; ++n)
      t.value.push_back(averaged ? (kernel.derivative(n - 1, z + half) - kernel.derivative(n - 1, z - half)) /
                                       lattice.spacing
                                 : kernel.derivative(n, z));
  }
  return t;
}

// Adds the expansions of `m` at the node that is the lower edge of bin `edge`. Channels from `first_stress` on use Phi.
void add_expansions(const BinMoments& m, const Table& t, std::int64_t edge, std::size_t first_stress, double* value,
                    double* slope) {
  const auto width = static_cast<std::size_t>(m.width);
  const std::int64_t lo = std::max(edge - t.reach, m.first), hi = std::min(edge + t.reach, m.first + m.count);
  for (std::int64_t b = lo; b < hi; ++b) {
    const double* d = t.row(b - edge);
    const double* bin = m.data.data() + static_cast<std::size_t>((b - m.first) * m.terms) * width;
    for (std::size_t k = 0; k < static_cast<std::size_t>(t.terms); ++k) {
      const double* M = bin + k * width;
      for (std::size_t c = 0; c < first_stress; ++c) value[c] += d[k + 1] * M[c];
      for (std::size_t c = 0; c < first_stress; ++c) slope[c] += d[k + 2] * M[c];
      for (std::size_t c = first_stress; c < width; ++c) value[c] += d[k] * M[c];
      for (std::size_t c = first_stress; c < width; ++c) slope[c] += d[k + 1] * M[c];
    }
  }
}

// below[b][c]: sum of the zeroth moments of the stress channels over all bins before b, where Phi = 1.
std::vector<double> totals_below(const BinMoments& m, std::size_t first_stress) {
  const std::size_t width = static_cast<std::size_t>(m.width), n = width - first_stress;
  std::vector<double> below((static_cast<std::size_t>(m.count) + 1) * n);
  for (std::size_t b = 0; b < static_cast<std::size_t>(m.count); ++b)
    for (std::size_t c = 0; c < n; ++c)
      below[(b + 1) * n + c] =
          below[b * n + c] + m.data[b * static_cast<std::size_t>(m.terms) * width + first_stress + c];
  return below;
}

void add_below(const BinMoments& m, const std::vector<double>& below, std::int64_t until, std::size_t first_stress,
               double* value) {
  if (m.count == 0) return;
  const std::size_t n = static_cast<std::size_t>(m.width) - first_stress;
  const auto b = static_cast<std::size_t>(std::clamp<std::int64_t>(until - m.first, 0, m.count));
  for (std::size_t c = 0; c < n; ++c) value[first_stress + c] += below[b * n + c];
}

}  // namespace

void cover(BinMoments& m, std::int64_t b, double z) {
  if (b >= m.first && b < m.first + m.count) return;
  const std::int64_t spare = std::max<std::int64_t>(16, m.count / 8);
  const std::int64_t lo = m.count == 0 ? b - spare : std::min(m.first, b - spare);
  const std::int64_t hi = m.count == 0 ? b + spare + 1 : std::max(m.first + m.count, b + spare + 1);
  if (hi - lo > most_bins)
    throw NumericalError(fmt::format(
        "depth profile: a grain at z = {:.6g} is too far from the others, it would take {} bins", z, hi - lo));
  std::vector<double> grown(static_cast<std::size_t>((hi - lo) * m.terms * m.width));
  std::copy(m.data.begin(), m.data.end(), grown.begin() + (m.count == 0 ? 0 : (m.first - lo) * m.terms * m.width));
  m.data = std::move(grown);
  m.first = lo;
  m.count = hi - lo;
}

Lattice make_lattice(const laws::CgKernels::Any& kernel, double spacing, double origin) {
  return std::visit(
      [&](const auto& k) {
        const double finest = k.support(1) / static_cast<double>(bins_per_support);
        Lattice l{origin, spacing, 2};
        if constexpr (std::is_same_v<std::decay_t<decltype(k)>, laws::CgGaussian>) {
          l.bins_per_node =
              2 * std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(spacing / (2 * finest) - 1e-9)));
        } else {  // knots at 0 and at the cut-off have to be edges
          l.bins_per_node = 2 * std::max<std::int64_t>(1, std::llround(spacing / (2 * finest)));
          l.spacing = static_cast<double>(l.bins_per_node) * finest;
        }
        return l;
      },
      kernel);
}

ProfileMoments make_moments(const laws::CgKernels::Any& kernel, const Lattice& lattice, const Box& box) {
  ProfileMoments p{kernel, lattice, box.length.x * box.length.y, 0, 0, {}, {}, {}};
  if (box.periodic[2]) throw UnphysicalError("cg", "a depth profile needs a direction z that is not periodic");
  if (!(p.area > 0)) throw UnphysicalError("cg", "a depth profile needs a box with an extent in x and y");
  const std::int64_t terms =
      std::visit([](const auto& k) -> std::int64_t { return std::decay_t<decltype(k)>::expansion_terms; }, kernel);
  p.flow = {0, 0, kFlowing, terms, {}};
  p.base = {0, 0, kChannels - kBase, terms, {}};
  return p;
}

void clear(ProfileMoments& p) {
  p.samples = 0;
  p.contacts = 0;
  p.base_force = {};
  std::fill(p.flow.data.begin(), p.flow.data.end(), 0.0);
  std::fill(p.base.data.begin(), p.base.data.end(), 0.0);
}

void add_moments(ProfileMoments& to, const ProfileMoments& from) {
  const auto add_bins = [](BinMoments& a, const BinMoments& b) {
    if (b.count == 0) return;
    for (std::int64_t edge : {b.first, b.first + b.count - 1}) cover(a, edge, 0);
    double* data = bin_data(a, b.first);
    for (std::size_t k = 0; k < b.data.size(); ++k) data[k] += b.data[k];
  };
  add_bins(to.flow, from.flow);
  add_bins(to.base, from.base);
  to.samples += from.samples;
  to.contacts += from.contacts;
  to.base_force += from.base_force;
}

ProfileSums evaluate(const ProfileMoments& p, std::int64_t first, std::int64_t count, bool averaged) {
  const Table table = std::visit([&](const auto& k) { return make_table(k, p.lattice, averaged); }, p.kernel);
  const std::vector<double> flow_below = totals_below(p.flow, kCarried), base_below = totals_below(p.base, 0);
  ProfileSums out{first, std::vector<Row>(static_cast<std::size_t>(count)),
                  std::vector<Row>(static_cast<std::size_t>(count))};
  for (std::int64_t n = 0; n < count; ++n) {
    Row &value = out.value[static_cast<std::size_t>(n)], &slope = out.slope[static_cast<std::size_t>(n)];
    const std::int64_t edge = (first + n) * p.lattice.bins_per_node;
    add_expansions(p.flow, table, edge, kCarried, value.data(), slope.data());
    add_below(p.flow, flow_below, edge - table.reach, kCarried, value.data());
    add_expansions(p.base, table, edge, 0, value.data() + kBase, slope.data() + kBase);
    add_below(p.base, base_below, edge - table.reach, 0, value.data() + kBase);
    for (int a = 0; a < 3; ++a) value[kBase + static_cast<std::size_t>(3 * a + 2)] += p.base_force[a];  // Phi - 1
    for (double& v : value) v /= p.area;
    for (double& v : slope) v /= p.area;
  }
  return out;
}

NodeRange reach(const ProfileMoments& p) {
  if (p.flow.count == 0) return {};
  const double support = std::visit([](const auto& k) { return k.support(1); }, p.kernel);
  std::int64_t lo = p.flow.first, hi = p.flow.first + p.flow.count;
  if (p.base.count > 0) {
    lo = std::min(lo, p.base.first);
    hi = std::max(hi, p.base.first + p.base.count);
  }
  const auto margin = static_cast<std::int64_t>(std::ceil(support / p.lattice.bin())) + p.lattice.bins_per_node;
  const auto down = static_cast<std::int64_t>(
      std::floor(static_cast<double>(lo - margin) / static_cast<double>(p.lattice.bins_per_node)));
  const auto up = static_cast<std::int64_t>(
      std::ceil(static_cast<double>(hi + margin) / static_cast<double>(p.lattice.bins_per_node)));
  return {down, up - down + 1};
}

}  // namespace bagnold::cg

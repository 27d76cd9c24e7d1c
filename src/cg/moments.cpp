#include "cg/moments.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/simd.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::cg {
namespace {

constexpr std::int64_t most_bins = 1 << 16;

// coefficient[k][j]: what the value at the Chebyshev node j contributes to the power s^k of the interpolating polynomial,
// sum_n 2/terms T_n(s_j) T_n(s) with the term n = 0 halved.
template <std::size_t terms>
struct Interpolation {
  std::array<double, terms> node{};
  std::array<std::array<double, terms>, terms> coefficient{};
  Interpolation() {
    std::array<std::array<double, terms>, terms> T{};  // T_n(s) by powers
    for (std::size_t n = 0; n < terms; ++n) {
      for (std::size_t k = 0; k + 1 < terms && n > 0; ++k) T[n][k + 1] = (n == 1 ? 1 : 2) * T[n - 1][k];
      for (std::size_t k = 0; k < terms; ++k) T[n][k] -= n < 2 ? 0 : T[n - 2][k];
      if (n == 0) T[0][0] = 1;
      for (std::size_t j = 0; j < terms; ++j) {
        const double angle = std::numbers::pi * (static_cast<double>(j) + 0.5) / terms;
        node[j] = std::cos(angle);
        for (std::size_t k = 0; k < terms; ++k)
          coefficient[k][j] += (n == 0 ? 1.0 : 2.0) / terms * std::cos(static_cast<double>(n) * angle) * T[n][k];
      }
    }
  }
};

// What turns moments into values: for a node at a place in its bin (its phase) and an expansion in the bin m bins
// further up, the coefficients of Phi, g and g' (or of their means over the averaging interval).
struct Table {
  std::int64_t reach;  // bins m: [-reach, reach)
  int terms;
  std::vector<double> value;  // [phase][2 reach][3][terms]
  const double* row(std::int64_t phase, std::int64_t m) const {
    return value.data() + static_cast<std::size_t>((phase * 2 * reach + m + reach) * 3 * terms);
  }
};

template <class Kernel>
Table make_table(const Kernel& kernel, const Lattice& lattice, bool averaged) {
  constexpr int terms = Kernel::expansion_terms;
  const Interpolation<static_cast<std::size_t>(terms)> interpolation;
  const double h = lattice.bin(), half = lattice.spacing / 2;
  const double furthest = kernel.support(1) + (averaged ? half : 0) + (lattice.nodes_per_bin > 1 ? h : 0);
  Table t{static_cast<std::int64_t>(std::ceil(furthest / h - 1e-9)), terms, {}};
  for (std::int64_t phase = 0; phase < lattice.nodes_per_bin; ++phase)
    for (std::int64_t m = -t.reach; m < t.reach; ++m)
      for (int n = -1; n <= 1; ++n) {
        std::array<double, terms> at_nodes;
        for (std::size_t j = 0; j < terms; ++j) {
          const double z = static_cast<double>(phase) * lattice.spacing -
                           (static_cast<double>(m) + 0.5 + 0.5 * interpolation.node[j]) * h;
          at_nodes[j] =
              averaged ? (kernel.derivative(n - 1, z + half) - kernel.derivative(n - 1, z - half)) / lattice.spacing
                       : kernel.derivative(n, z);
        }
        for (const auto& row : interpolation.coefficient)
          t.value.push_back(std::inner_product(row.begin(), row.end(), at_nodes.begin(), 0.0));
      }
  return t;
}

// A node as bins see it: the bin that begins at it or holds it, and its place in there.
struct NodeInBins {
  std::int64_t bin, phase;
  NodeInBins(const Lattice& l, std::int64_t n) : bin(n * l.bins_per_node), phase(0) {
    if (l.nodes_per_bin == 1) return;
    phase = (n % l.nodes_per_bin + l.nodes_per_bin) % l.nodes_per_bin;
    bin = (n - phase) / l.nodes_per_bin;
  }
};

// Adds the expansions of `m` at a node. Channels from `first_stress` on use Phi.
void add_expansions(const BinMoments& m, const Table& t, const NodeInBins& node, std::size_t first_stress,
                    double* value, double* slope) {
  constexpr std::size_t lanes = Pack::lanes, most = kFlowing / lanes;
  const auto width = static_cast<std::size_t>(m.width), terms = static_cast<std::size_t>(t.terms),
             packs = width / lanes;
  Pack values[most], slopes[most];
  Mask is_stress[most];
  for (std::size_t q = 0; q < packs; ++q) {
    values[q] = Pack::load_unaligned(value + q * lanes);
    slopes[q] = Pack::load_unaligned(slope + q * lanes);
    Pack beyond = 0.0;
    for (std::size_t c = 0; c < lanes; ++c) beyond.set(static_cast<int>(c), q * lanes + c < first_stress ? 1 : -1);
    is_stress[q] = beyond < Pack(0);
  }
  const std::int64_t lo = std::max(node.bin - t.reach, m.first), hi = std::min(node.bin + t.reach, m.first + m.count);
  for (std::int64_t b = lo; b < hi; ++b) {
    const double* d = t.row(node.phase, b - node.bin);
    const double* M = m.data.data() + static_cast<std::size_t>((b - m.first) * m.terms) * width;
    for (std::size_t k = 0; k < terms; ++k, M += width) {
      const double integral = d[k], kernel = d[terms + k], derivative = d[2 * terms + k];
      for (std::size_t q = 0; q < packs; ++q) {
        const Pack moments = Pack::load_unaligned(M + q * lanes);
        values[q] += select(is_stress[q], Pack(integral), Pack(kernel)) * moments;
        slopes[q] += select(is_stress[q], Pack(kernel), Pack(derivative)) * moments;
      }
      for (std::size_t c = packs * lanes; c < width; ++c) {
        value[c] += (c < first_stress ? kernel : integral) * M[c];
        slope[c] += (c < first_stress ? derivative : kernel) * M[c];
      }
    }
  }
  for (std::size_t q = 0; q < packs; ++q) {
    values[q].store_unaligned(value + q * lanes);
    slopes[q].store_unaligned(slope + q * lanes);
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
        const double finest = k.support(1) / static_cast<double>(k.bins_per_support);
        Lattice l{origin, spacing};
        if constexpr (std::is_same_v<std::decay_t<decltype(k)>, laws::CgGaussian>) {
          l.bins_per_node = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(spacing / finest - 1e-9)));
          l.nodes_per_bin = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::floor(finest / spacing + 1e-9)));
        } else {  // knots at 0, at the cut-off and at the edges of averaging intervals have to be edges
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
    const NodeInBins node(p.lattice, first + n);
    add_expansions(p.flow, table, node, kCarried, value.data(), slope.data());
    add_below(p.flow, flow_below, node.bin - table.reach, kCarried, value.data());
    add_expansions(p.base, table, node, 0, value.data() + kBase, slope.data() + kBase);
    add_below(p.base, base_below, node.bin - table.reach, 0, value.data() + kBase);
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
  const double margin = support + p.lattice.spacing, h = p.lattice.bin();
  const auto down =
      static_cast<std::int64_t>(std::floor((static_cast<double>(lo) * h - margin) / p.lattice.spacing - 1e-9));
  const auto up =
      static_cast<std::int64_t>(std::ceil((static_cast<double>(hi) * h + margin) / p.lattice.spacing + 1e-9));
  return {down, up - down + 1};
}

}  // namespace bagnold::cg

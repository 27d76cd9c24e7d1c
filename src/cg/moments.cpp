#include "cg/moments.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "cg/carried.hpp"
#include "core/error.hpp"

namespace bagnold::cg {
namespace {

constexpr std::int64_t bins_per_support = 64;
constexpr std::int64_t most_bins = 1 << 16;
constexpr std::size_t contact_row = 16;       // doubles per grain: 9 stress, 6 fabric, 1 unused
constexpr std::int64_t flow_width = kFlowing, base_width = 9;

struct Place {
  std::int64_t bin;
  double delta;   // z minus the centre of the bin
};

Place place(const ProfileMoments& p, double z, double per_bin) {
  const double s = (z - p.lattice.origin) * per_bin;
  if (!(std::abs(s) < 1e15)) throw NumericalError(fmt::format("depth profile: a grain is at z = {}", z));
  const double b = std::floor(s);
  return {static_cast<std::int64_t>(b), (s - b - 0.5) * p.lattice.bin()};
}

// Makes sure that bin b exists. Grows by some more than asked, so that it happens rarely.
void cover(BinMoments& m, std::int64_t b, double z) {
  if (b >= m.first && b < m.first + m.count) return;
  const std::int64_t spare = std::max<std::int64_t>(16, m.count / 8);
  const std::int64_t lo = m.count == 0 ? b - spare : std::min(m.first, b - spare);
  const std::int64_t hi = m.count == 0 ? b + spare + 1 : std::max(m.first + m.count, b + spare + 1);
  if (hi - lo > most_bins)
    throw NumericalError(fmt::format("depth profile: a grain at z = {:.6g} is too far from the others, it would take {} bins", z, hi - lo));
  std::vector<double> grown(static_cast<std::size_t>((hi - lo) * m.terms * m.width));
  std::copy(m.data.begin(), m.data.end(), grown.begin() + (m.count == 0 ? 0 : (m.first - lo) * m.terms * m.width));
  m.data = std::move(grown);
  m.first = lo;
  m.count = hi - lo;
}

double* bin_data(BinMoments& m, std::int64_t b) { return m.data.data() + (b - m.first) * m.terms * m.width; }

template <int terms, std::int64_t width>
void deposit(double* __restrict bin, double delta, const double* __restrict q) {
  double c = 1;
  for (int k = 0; k < terms; ++k) {
    double* __restrict row = bin + k * width;
    for (std::int64_t a = 0; a < width; ++a) row[a] += c * q[a];
    c *= -delta / (k + 1);
  }
}

// -f_a r_b (g + r_z^2/24 g'') about a point: Phi^(1) and Phi^(3), so every moment moves up by one and by three.
void deposit_level(BinMoments& m, std::size_t channel, const Place& at, const Vec3& f, const Vec3& r) {
  double* bin = bin_data(m, at.bin);
  double c = 1;
  for (std::int64_t k = 0; k + 1 < m.terms; ++k) {
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 2; ++b) {
        const double t = -f[a] * r[b] * c;
        const std::size_t to = channel + static_cast<std::size_t>(3 * a + b);
        bin[static_cast<std::size_t>((k + 1) * m.width) + to] += t;
        if (k + 3 < m.terms) bin[static_cast<std::size_t>((k + 3) * m.width) + to] += t * r.z * r.z / 24;
      }
    c *= -at.delta / static_cast<double>(k + 1);
  }
}

// A contact with the base: sigma_az over everything below grain i, the other components from i to the contact point.
template <int terms>
void add_base_contact(ProfileMoments& p, const Snapshot& s, const dem::Contact& c, double per_bin, double level) {
  const double z = s.x[static_cast<std::size_t>(c.i)].z;
  const Vec3 arm = arm_from_contact(s, c), f = c.force;
  const bool is_level = std::abs(arm.z) < level;
  const double per_z = is_level ? 0 : 1 / arm.z;
  std::array<double, 9> q{f.x * arm.x * per_z, f.x * arm.y * per_z, f.x, f.y * arm.x * per_z, f.y * arm.y * per_z, f.y,
                          f.z * arm.x * per_z, f.z * arm.y * per_z, f.z};
  const Place top = place(p, z, per_bin), bottom = place(p, z - arm.z, per_bin), middle = place(p, z - 0.5 * arm.z, per_bin);
  for (const Place& at : {top, bottom, middle}) cover(p.base, at.bin, z);
  deposit<terms, base_width>(bin_data(p.base, top.bin), top.delta, q.data());
  if (is_level) {
    deposit_level(p.base, 0, middle, f, arm);
  } else {
    q[2] = q[5] = q[8] = 0;
    for (double& t : q) t = -t;
    deposit<terms, base_width>(bin_data(p.base, bottom.bin), bottom.delta, q.data());
  }
  p.base_force -= f;
}

// Gives every flowing grain its share of the contact stress (C_i of the sheet) and its fabric.
template <int terms>
void gather_contacts(ProfileMoments& p, const Snapshot& s, std::vector<double>& rows, double per_bin, double level) {
  for (const dem::Contact& c : s.contacts) {
    double* __restrict to_i = rows.data() + contact_row * static_cast<std::size_t>(c.i);
    if (touches_base(s, c)) {
      add_normal(to_i + 9, c.normal);
      add_base_contact<terms>(p, s, c, per_bin, level);
      continue;
    }
    double* __restrict to_j = rows.data() + contact_row * static_cast<std::size_t>(c.j);
    const Vec3 &r = c.branch, &f = c.force, &n = c.normal;
    double x = 0, y = 0;
    if (std::abs(r.z) >= level) {
      const double per_z = 1 / r.z;
      x = r.x * per_z;
      y = r.y * per_z;
    } else {
      const double z = s.x[static_cast<std::size_t>(c.i)].z - 0.5 * r.z;
      const Place middle = place(p, z, per_bin);
      cover(p.flow, middle.bin, z);
      deposit_level(p.flow, kContact, middle, f, r);
    }
    // Action, reaction and the same fabric for both.
    const std::array<double, contact_row> t{f.x * x,   f.x * y,   f.x,       f.y * x,   f.y * y,   f.y,       f.z * x,   f.z * y,
                                            f.z,       n.x * n.x, n.x * n.y, n.x * n.z, n.y * n.y, n.y * n.z, n.z * n.z, 0};
    for (std::size_t k = 0; k < contact_row; ++k) to_i[k] += t[k];
    for (std::size_t k = 0; k < contact_row; ++k) to_j[k] += k < 9 ? -t[k] : t[k];
  }
}

// Sorts the flowing grains by bin (stable, so sums are taken in the order of the grains).
void sort_by_bin(const ProfileMoments& p, const Snapshot& s, ProfileScratch& w) {
  const double per_bin = 1 / p.lattice.bin();
  const auto n = static_cast<std::size_t>(s.flowing);
  w.bin.resize(n);
  w.delta.resize(n);
  w.order.resize(n);
  w.begin.assign(static_cast<std::size_t>(p.flow.count) + 1, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const Place at = place(p, s.x[i].z, per_bin);
    w.bin[i] = static_cast<std::int32_t>(at.bin - p.flow.first);
    w.delta[i] = at.delta;
    ++w.begin[static_cast<std::size_t>(w.bin[i]) + 1];
  }
  for (std::size_t b = 1; b < w.begin.size(); ++b) w.begin[b] += w.begin[b - 1];
  w.next.assign(w.begin.begin(), w.begin.end() - 1);
  for (std::size_t i = 0; i < n; ++i)
    w.order[static_cast<std::size_t>(w.next[static_cast<std::size_t>(w.bin[i])]++)] = static_cast<std::int32_t>(i);
}

// Eight channels at once; the compiler maps it to the vectors of the machine.
using Lanes = double __attribute__((vector_size(64), aligned(8), may_alias));

// Grains of one bin, a few at a time: what they carry and their powers (-delta)^k/k!. Small enough for the first-level cache.
struct Batch {
  static constexpr std::size_t most = 16;
  alignas(64) std::array<std::array<double, flow_width>, most> carried;
  alignas(64) std::array<std::array<double, 8>, most> powers;
};

void fill(Batch& batch, const Snapshot& s, const ProfileScratch& w, std::size_t begin, std::size_t n) {
  for (std::size_t g = 0; g < n; ++g) {
    const auto i = static_cast<std::size_t>(w.order[begin + g]);
    double* __restrict q = batch.carried[g].data();
    const double* __restrict from_contacts = w.of_contacts.data() + contact_row * i;
    carried_by_grain(q, s, i, from_contacts + 9);
    for (std::size_t k = 0; k < 9; ++k) q[kContact + k] = from_contacts[k];
    const double d = w.delta[i], d2 = d * d, d3 = d2 * d, d4 = d2 * d2;
    batch.powers[g] = {1, -d, d2 / 2, -d3 / 6, d4 / 24, -d4 * d / 120, d4 * d2 / 720, -d4 * d3 / 5040};
  }
}

// Adds a batch to its bin, eight channels at a time, so that their moments stay in registers.
template <int terms>
void deposit_batch(double* __restrict bin, const Batch& batch, std::size_t n) {
  for (std::int64_t c = 0; c < flow_width; c += 8) {
    Lanes sum[terms];
#pragma GCC unroll 8
    for (int k = 0; k < terms; ++k) sum[k] = *reinterpret_cast<const Lanes*>(bin + k * flow_width + c);
    for (std::size_t g = 0; g < n; ++g) {
      const Lanes q = *reinterpret_cast<const Lanes*>(batch.carried[g].data() + c);
      const double* power = batch.powers[g].data();
#pragma GCC unroll 8
      for (int k = 0; k < terms; ++k) sum[k] += power[k] * q;
    }
#pragma GCC unroll 8
    for (int k = 0; k < terms; ++k) *reinterpret_cast<Lanes*>(bin + k * flow_width + c) = sum[k];
  }
}

template <int terms>
void add(ProfileMoments& p, const Snapshot& s, ProfileScratch& w, double level) {
  const double per_bin = 1 / p.lattice.bin();
  const auto n = static_cast<std::size_t>(s.flowing);
  w.of_contacts.assign(contact_row * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) cover(p.flow, place(p, s.x[i].z, per_bin).bin, s.x[i].z);
  gather_contacts<terms>(p, s, w.of_contacts, per_bin, level);
  sort_by_bin(p, s, w);
  Batch batch;
  for (std::size_t b = 0; b + 1 < w.begin.size(); ++b)
    for (auto first = static_cast<std::size_t>(w.begin[b]); first < static_cast<std::size_t>(w.begin[b + 1]); first += Batch::most) {
      const std::size_t count = std::min(Batch::most, static_cast<std::size_t>(w.begin[b + 1]) - first);
      fill(batch, s, w, first, count);
      deposit_batch<terms>(p.flow.data.data() + b * terms * flow_width, batch, count);
    }
  p.contacts += static_cast<double>(s.contacts.size());
  ++p.samples;
}

// What turns moments into values: for a node in the middle of an expansion at a distance of (m - 1/2) bins, the
// derivatives -1 ... terms of the kernel (index shifted by one), or their means over the averaging interval.
struct Table {
  std::int64_t reach;   // bins on either side of a node
  int terms;
  std::vector<double> value;   // [2 reach][terms + 2]
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
    const double z = -(static_cast<double>(m) + 0.5) * h;   // node minus centre of the bin m bins above it
    for (int n = -1; n <= t.terms; ++n)
      t.value.push_back(averaged ? (kernel.derivative(n - 1, z + half) - kernel.derivative(n - 1, z - half)) / lattice.spacing
                                 : kernel.derivative(n, z));
  }
  return t;
}

// Adds the expansions of `m` at the node that is the lower edge of bin `edge`. Channels from `first_stress` on use Phi.
void add_expansions(const BinMoments& m, const Table& t, std::int64_t edge, std::size_t first_stress, double* value, double* slope) {
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
      below[(b + 1) * n + c] = below[b * n + c] + m.data[b * static_cast<std::size_t>(m.terms) * width + first_stress + c];
  return below;
}

void add_below(const BinMoments& m, const std::vector<double>& below, std::int64_t until, std::size_t first_stress, double* value) {
  if (m.count == 0) return;
  const std::size_t n = static_cast<std::size_t>(m.width) - first_stress;
  const auto b = static_cast<std::size_t>(std::clamp<std::int64_t>(until - m.first, 0, m.count));
  for (std::size_t c = 0; c < n; ++c) value[first_stress + c] += below[b * n + c];
}

}  // namespace

Lattice make_lattice(const laws::CgKernels::Any& kernel, double spacing, double origin) {
  return std::visit(
      [&](const auto& k) {
        const double finest = k.support(1) / static_cast<double>(bins_per_support);
        Lattice l{origin, spacing, 2};
        if constexpr (std::is_same_v<std::decay_t<decltype(k)>, laws::CgGaussian>) {
          l.bins_per_node = 2 * std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(spacing / (2 * finest) - 1e-9)));
        } else {   // knots at 0 and at the cut-off have to be edges
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
  const std::int64_t terms = std::visit([](const auto& k) -> std::int64_t { return std::decay_t<decltype(k)>::expansion_terms; }, kernel);
  p.flow = {0, 0, flow_width, terms, {}};
  p.base = {0, 0, base_width, terms, {}};
  return p;
}

void add_snapshot(ProfileMoments& p, const Snapshot& s, ProfileScratch& scratch) {
  std::visit([&](const auto& k) { add<std::decay_t<decltype(k)>::expansion_terms>(p, s, scratch, 2e-3 * k.width); }, p.kernel);
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
  ProfileSums out{first, std::vector<Row>(static_cast<std::size_t>(count)), std::vector<Row>(static_cast<std::size_t>(count))};
  for (std::int64_t n = 0; n < count; ++n) {
    Row &value = out.value[static_cast<std::size_t>(n)], &slope = out.slope[static_cast<std::size_t>(n)];
    const std::int64_t edge = (first + n) * p.lattice.bins_per_node;
    add_expansions(p.flow, table, edge, kCarried, value.data(), slope.data());
    add_below(p.flow, flow_below, edge - table.reach, kCarried, value.data());
    add_expansions(p.base, table, edge, 0, value.data() + kBase, slope.data() + kBase);
    add_below(p.base, base_below, edge - table.reach, 0, value.data() + kBase);
    for (int a = 0; a < 3; ++a) value[kBase + static_cast<std::size_t>(3 * a + 2)] += p.base_force[a];   // Phi - 1
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
  const auto down = static_cast<std::int64_t>(std::floor(static_cast<double>(lo - margin) / static_cast<double>(p.lattice.bins_per_node)));
  const auto up = static_cast<std::int64_t>(std::ceil(static_cast<double>(hi + margin) / static_cast<double>(p.lattice.bins_per_node)));
  return {down, up - down + 1};
}

}  // namespace bagnold::cg

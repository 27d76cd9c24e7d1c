// Gathering: from the grains and contacts of one instant to the moments of cg/moments.hpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "cg/carried.hpp"
#include "cg/moments.hpp"
#include "core/error.hpp"
#include "dem/contacts.hpp"

namespace bagnold::cg {
namespace {

constexpr std::size_t contact_row = 16;  // doubles per grain: 9 stress, 6 fabric, 1 unused
constexpr std::size_t flow_width = kFlowing, base_width = kChannels - kBase;

// Eight channels at once; the compiler maps it to the vectors of the machine.
using Lanes = double __attribute__((vector_size(64), aligned(8), may_alias));
Lanes& lanes(double* p) { return *reinterpret_cast<Lanes*>(p); }
const Lanes& lanes(const double* p) { return *reinterpret_cast<const Lanes*>(p); }

// Where grains come from: a Snapshot, whose velocities belong to the time of the positions, or a running engine.
struct SnapshotGrains {
  const Snapshot& s;
  std::int64_t flowing() const { return s.flowing; }
  double z(std::size_t i) const { return s.x[i].z; }
  double diameter(std::size_t i) const { return s.diameter[i]; }
  void carried(double* q, std::size_t i, const double* nn) const { carried_by_grain(q, s, i, nn); }
};
struct StateGrains {
  const dem::DemState& s;
  double half;  // velocities are half a step behind once it moves
  std::int64_t flowing() const { return s.grains.flowing; }
  double z(std::size_t i) const { return s.grains.x[i].z; }
  double diameter(std::size_t i) const { return s.grains.diameter[i]; }
  void carried(double* q, std::size_t i, const double* nn) const {
    const dem::Grains& g = s.grains;
    const Vec3 v = g.v[i] + half * (g.force[i] / g.mass[i] + s.gravity),
               omega = g.omega[i] + (half / g.inertia[i]) * g.torque[i];
    carried_by_grain(q, g.mass[i], g.inertia[i], g.diameter[i], v, omega, nn);
  }
};

struct Place {
  std::int64_t bin;
  double delta;  // z minus the centre of the bin
};

Place place(const ProfileMoments& p, double z, double per_bin) {
  const double s = (z - p.lattice.origin) * per_bin;
  if (!(std::abs(s) < 1e15)) throw NumericalError(fmt::format("depth profile: a grain is at z = {}", z));
  const double b = std::floor(s);
  return {static_cast<std::int64_t>(b), (s - b - 0.5) * p.lattice.bin()};
}

// Base channels: eight at once, and the ninth.
template <int terms>
void deposit_base(double* bin, double delta, const std::array<double, base_width>& q) {
  double c = 1;
  for (int k = 0; k < terms; ++k, bin += base_width) {
    lanes(bin) += c * lanes(q.data());
    bin[8] += c * q[8];
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
template <int terms, class Grains, class Contact>
void add_base_contact(ProfileMoments& p, const Grains& grains, const Contact& c, double per_bin, double level) {
  const auto i = static_cast<std::size_t>(c.i);
  const double z = grains.z(i);
  const Vec3 arm = arm_from_contact(grains.diameter(i), c), f = c.force;
  const bool is_level = std::abs(arm.z) < level;
  const double per_z = is_level ? 0 : 1 / arm.z;
  std::array<double, base_width> q{f.x * arm.x * per_z, f.x * arm.y * per_z, f.x,
                                   f.y * arm.x * per_z, f.y * arm.y * per_z, f.y,
                                   f.z * arm.x * per_z, f.z * arm.y * per_z, f.z};
  const Place top = place(p, z, per_bin), bottom = place(p, z - arm.z, per_bin),
              middle = place(p, z - 0.5 * arm.z, per_bin);
  for (const Place& at : {top, bottom, middle}) cover(p.base, at.bin, z);
  deposit_base<terms>(bin_data(p.base, top.bin), top.delta, q);
  if (is_level) {
    deposit_level(p.base, 0, middle, f, arm);
  } else {
    q[2] = q[5] = q[8] = 0;
    for (double& t : q) t = -t;
    deposit_base<terms>(bin_data(p.base, bottom.bin), bottom.delta, q);
  }
  p.base_force -= f;
}

// Gives every flowing grain its share of the contact stress (C_i of the sheet) and its fabric.
template <int terms, class Grains, class Contact>
void gather_contacts(ProfileMoments& p, const Grains& grains, std::span<const Contact> contacts, double* rows,
                     double per_bin, double level) {
  const Lanes opposite{-1, 1, 1, 1, 1, 1, 1, 1};
  for (const Contact& c : contacts) {
    double* to_i = rows + contact_row * static_cast<std::size_t>(c.i);
    const Vec3 &r = c.branch, &f = c.force, &n = c.normal;
    if (touches_base(grains.flowing(), c)) {
      add_normal(to_i + 9, n);
      add_base_contact<terms>(p, grains, c, per_bin, level);
      continue;
    }
    double* to_j = rows + contact_row * static_cast<std::size_t>(c.j);
    double x = 0, y = 0;
    if (std::abs(r.z) >= level) {
      const double per_z = 1 / r.z;
      x = r.x * per_z;
      y = r.y * per_z;
    } else {
      const double z = grains.z(static_cast<std::size_t>(c.i)) - 0.5 * r.z;
      const Place middle = place(p, z, per_bin);
      cover(p.flow, middle.bin, z);
      deposit_level(p.flow, kContact, middle, f, r);
    }
    // Action, reaction and the same fabric for both.
    const Lanes stress{f.x * x, f.x * y, f.x, f.y * x, f.y * y, f.y, f.z * x, f.z * y};
    const Lanes rest{f.z, n.x * n.x, n.x * n.y, n.x * n.z, n.y * n.y, n.y * n.z, n.z * n.z, 0};
    lanes(to_i) += stress;
    lanes(to_i + 8) += rest;
    lanes(to_j) -= stress;
    lanes(to_j + 8) += opposite * rest;
  }
  p.contacts += static_cast<double>(contacts.size());
}

// Sorts the flowing grains by bin (stable, so sums are taken in the order of the grains).
template <class Grains>
void sort_by_bin(ProfileMoments& p, const Grains& grains, ProfileScratch& w) {
  const double per_bin = 1 / p.lattice.bin();
  const auto n = static_cast<std::size_t>(grains.flowing());
  w.bin.resize(n);
  w.delta.resize(n);
  w.order.resize(n);
  if (n > 0) cover(p.flow, place(p, grains.z(0), per_bin).bin, grains.z(0));
  const std::int64_t first = p.flow.first;
  for (std::size_t i = 0; i < n; ++i) {
    const Place at = place(p, grains.z(i), per_bin);
    cover(p.flow, at.bin, grains.z(i));
    w.bin[i] = static_cast<std::int32_t>(at.bin - first);
    w.delta[i] = at.delta;
  }
  const auto shift = static_cast<std::int32_t>(first - p.flow.first);  // by what the bins grew downwards
  w.begin.assign(static_cast<std::size_t>(p.flow.count) + 2, 0);
  const auto place_of = [&](std::size_t i) { return static_cast<std::size_t>(w.bin[i] + shift); };
  for (std::size_t i = 0; i < n; ++i) ++w.begin[place_of(i) + 2];
  for (std::size_t b = 2; b < w.begin.size(); ++b) w.begin[b] += w.begin[b - 1];
  for (std::size_t i = 0; i < n; ++i)
    w.order[static_cast<std::size_t>(w.begin[place_of(i) + 1]++)] = static_cast<std::int32_t>(i);
}

// Grains of one bin, a few at a time: what they carry and their powers (-delta)^k/k!. Small enough for the first-level cache.
struct Batch {
  static constexpr std::size_t most = 16;
  alignas(64) std::array<std::array<double, flow_width>, most> carried;
  alignas(64) std::array<std::array<double, 8>, most> powers;
};

// Takes the shares of the contacts out of their rows, which are zero again afterwards.
template <class Grains>
void fill(Batch& batch, const Grains& grains, const ProfileScratch& w, double* rows, std::size_t begin, std::size_t n) {
  for (std::size_t g = 0; g < n; ++g) {
    const auto i = static_cast<std::size_t>(w.order[begin + g]);
    double* q = batch.carried[g].data();
    double* from_contacts = rows + contact_row * i;
    grains.carried(q, i, from_contacts + 9);
    lanes(q + kContact) = lanes(from_contacts);
    q[kContact + 8] = from_contacts[8];
    lanes(from_contacts) = lanes(from_contacts + 8) = Lanes{};
    const double d = w.delta[i], d2 = d * d, d3 = d2 * d, d4 = d2 * d2;
    batch.powers[g] = {1,
                       -d,
                       d2 * (1.0 / 2),
                       d3 * (-1.0 / 6),
                       d4 * (1.0 / 24),
                       d4 * d * (-1.0 / 120),
                       d4 * d2 * (1.0 / 720),
                       d4 * d3 * (-1.0 / 5040)};
  }
}

// Adds a batch to its bin, eight channels at a time, so that their moments stay in registers.
template <int terms>
void deposit_batch(double* bin, const Batch& batch, std::size_t n) {
  for (std::size_t c = 0; c < flow_width; c += 8) {
    Lanes sum[terms];
#pragma GCC unroll 8
    for (std::size_t k = 0; k < terms; ++k) sum[k] = lanes(bin + k * flow_width + c);
    for (std::size_t g = 0; g < n; ++g) {
      const Lanes q = lanes(batch.carried[g].data() + c);
      const double* power = batch.powers[g].data();
#pragma GCC unroll 8
      for (std::size_t k = 0; k < terms; ++k) sum[k] += power[k] * q;
    }
#pragma GCC unroll 8
    for (std::size_t k = 0; k < terms; ++k) lanes(bin + k * flow_width + c) = sum[k];
  }
}

// for_each_batch(f): f(span of contacts) until all have been seen.
template <int terms, class Grains, class Contacts>
void add(ProfileMoments& p, const Grains& grains, const Contacts& for_each_batch, ProfileScratch& w, double level) {
  const double per_bin = 1 / p.lattice.bin();
  sort_by_bin(p, grains, w);
  std::vector<double> rows = std::move(w.of_contacts);  // not left half full if a contact is too far away
  rows.resize(contact_row * static_cast<std::size_t>(grains.flowing()));
  for_each_batch(
      [&](const auto& contacts) { gather_contacts<terms>(p, grains, contacts, rows.data(), per_bin, level); });
  Batch batch;
  for (std::size_t b = 0; b < static_cast<std::size_t>(p.flow.count); ++b)
    for (auto first = static_cast<std::size_t>(w.begin[b]); first < static_cast<std::size_t>(w.begin[b + 1]);
         first += Batch::most) {
      const std::size_t count = std::min(Batch::most, static_cast<std::size_t>(w.begin[b + 1]) - first);
      fill(batch, grains, w, rows.data(), first, count);
      deposit_batch<terms>(p.flow.data.data() + b * terms * flow_width, batch, count);
    }
  w.of_contacts = std::move(rows);
  ++p.samples;
}

template <class Grains, class Contacts>
void add(ProfileMoments& p, const Grains& grains, const Contacts& contacts, ProfileScratch& scratch) {
  std::visit(
      [&](const auto& k) {
        add<std::decay_t<decltype(k)>::expansion_terms>(p, grains, contacts, scratch, 2e-3 * k.width);
      },
      p.kernel);
}

}  // namespace

void add_snapshot(ProfileMoments& p, const Snapshot& s, ProfileScratch& scratch) {
  add(
      p, SnapshotGrains{s}, [&](const auto& f) { f(s.contacts); }, scratch);
}

void add_state(ProfileMoments& p, const dem::DemState& state, const dem::ContactLaws& laws, ProfileScratch& scratch) {
  const StateGrains grains{state, state.step == 0 ? 0 : 0.5 * state.dt};
  add(
      p, grains, [&](const auto& f) { dem::for_contact_batches(state, laws, std::ref(f)); }, scratch);
}

}  // namespace bagnold::cg

// Gathering from a Snapshot and from the state of a running engine.
#include <functional>
#include <span>
#include <type_traits>

#include <fmt/format.h>

#include "cg/carried.hpp"
#include "cg/gather.hpp"
#include "core/error.hpp"

namespace bagnold::cg {
namespace {

constexpr std::size_t base_width = kChannels - kBase;

// What a grain carries in channels [0, 8) and [8, 16), and its volume, which weighs its fabric.
struct PlainMemo {
  double volume = 0;
};
void carry(double m, double I, double d, const Vec3& v, const Vec3& omega, PlainMemo& memo, Lanes& a, Lanes& b) {
  alignas(64) std::array<double, kCarried> q;
  constexpr std::array<double, 6> no_contacts{};
  carried_by_grain(q.data(), m, I, d, v, omega, no_contacts.data());
  a = Lanes::load(q.data());
  b = Lanes::load(q.data() + 8);
  memo.volume = q[kVolume];
}

struct SnapshotGrains {
  using Memo = PlainMemo;
  static constexpr bool alike = false;
  Scales scales() const { return {}; }
  const Snapshot& s;
  double z(std::size_t i) const { return s.x[i].z; }
  double diameter(std::size_t i) const { return s.diameter[i]; }
  void carry(std::size_t i, Memo& memo, Lanes& a, Lanes& b) const {
    cg::carry(s.mass[i], s.inertia[i], s.diameter[i], s.v[i], s.omega[i], memo, a, b);
  }
};

struct StateGrains {
  using Memo = PlainMemo;
  static constexpr bool alike = false;
  Scales scales() const { return {}; }
  const dem::DemState& s;
  double half;  // velocities are half a step behind once it moves
  double z(std::size_t i) const { return s.grains.x[i].z; }
  double diameter(std::size_t i) const { return s.grains.diameter[i]; }
  void carry(std::size_t i, Memo& memo, Lanes& a, Lanes& b) const {
    const dem::Grains& g = s.grains;
    cg::carry(g.mass[i], g.inertia[i], g.diameter[i], g.v[i] + half * (g.force[i] / g.mass[i] + s.gravity),
              g.omega[i] + (half / g.inertia[i]) * g.torque[i], memo, a, b);
  }
};

// sum_k a_k (s_i^k - s_j^k)/(s_i - s_j) for f_a r_b, b = x and y: what -f_a r_b times the mean of g along the contact is.
void deposit_level(BinMoments& m, std::size_t channel, const Place& middle, double half_height, double bin,
                   const Vec3& f, const Vec3& r) {
  const double top = middle.s + half_height * (2 / bin), bottom = middle.s - half_height * (2 / bin);
  double difference = 0, power = 1;  // of s^k; s_j^k
  for (std::int64_t k = 0; k < m.terms; ++k) {
    double* to = bin_data(m, middle.bin) + k * m.width + channel;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 2; ++b) to[3 * a + b] += f[a] * r[b] * (2 / bin) * difference;
    difference = top * difference + power;
    power *= bottom;
  }
}

void deposit_base(BinMoments& m, const Place& at, const std::array<double, base_width>& q) {
  double* to = bin_data(m, at.bin);
  double power = 1;
  for (std::int64_t k = 0; k < m.terms; ++k, to += base_width, power *= at.s)
    for (std::size_t c = 0; c < base_width; ++c) to[c] += power * q[c];
}

// Gives every flowing grain its share of the contact stress (C_i of the sheet) and its fabric.
template <class Grains, class Contact>
void share_contact(ProfileMoments& p, const Grains& grains, std::int64_t flowing, const Contact& c, ProfileScratch& w,
                   double least_height) {
  const Vec3 &r = c.branch, &f = c.force, &n = c.normal;
  const dem::ContactForce contact{c.i, c.j, r, n, f, c.overlap};
  Lanes fabric(n.x * n.x, n.x * n.y, n.x * n.z, n.y * n.y, n.y * n.z, n.z * n.z, 0, 0);
  if (touches_base(flowing, c)) {
    share(w, static_cast<std::size_t>(c.i), fabric, 0.0);
    return add_base_contact(p, grains.z(static_cast<std::size_t>(c.i)), grains.diameter(static_cast<std::size_t>(c.i)),
                            contact);
  }
  const bool is_level = std::abs(r.z) < least_height;
  if (is_level) add_level_contact(p, grains.z(static_cast<std::size_t>(c.i)), contact);
  const double x = is_level ? 0 : r.x / r.z, y = is_level ? 0 : r.y / r.z;
  const Lanes stress(f.x * y, f.x, f.y * x, f.y * y, f.y, f.z * x, f.z * y, f.z);
  fabric.set(7, f.x * x);
  share(w, static_cast<std::size_t>(c.i), fabric, stress);
  fabric.set(7, -f.x * x);
  share(w, static_cast<std::size_t>(c.j), fabric, -stress);
}

// for_each_batch(f): f(span of contacts) until all have been seen.
template <class Grains, class Contacts>
void add(ProfileMoments& p, const Grains& grains, std::int64_t flowing, const Contacts& for_each_batch,
         ProfileScratch& w) {
  constexpr std::int64_t range = 1024;
  w.ranges.clear();
  for (std::int64_t i = 0; i < flowing; i += range)
    w.ranges.emplace_back(static_cast<std::size_t>(i), static_cast<std::size_t>(std::min(i + range, flowing)));
  sort_by_bin(p, grains, w);
  prepare_shares(w, static_cast<std::size_t>(flowing));
  const double least_height = level(p);
  for_each_batch([&](const auto& contacts) {
    for (const auto& c : contacts) share_contact(p, grains, flowing, c, w, least_height);
    p.contacts += static_cast<double>(contacts.size());
  });
  deposit_grains(p, grains, w);
  ++p.samples;
}

}  // namespace

void prepare_shares(ProfileScratch& w, std::size_t grains) {
  if (w.shares.size() < grains) w.shares.resize(grains);
  if (w.touches.size() < grains) w.touches.resize(grains);
  if (w.unfinished) std::fill(w.touches.begin(), w.touches.end(), std::uint8_t{0});
  w.unfinished = true;
}

Place place(const ProfileMoments& p, double z) {
  const double s = (z - p.lattice.origin) / p.lattice.bin();
  if (!(std::abs(s) < 1e9)) throw NumericalError(fmt::format("depth profile: a grain is at z = {}", z));
  const double b = std::floor(s);
  return {static_cast<std::int64_t>(b), 2 * (s - b) - 1};
}

double level(const ProfileMoments& p) {
  return std::visit([](const auto& k) { return 2e-3 * k.width; }, p.kernel);
}

void add_level_contact(ProfileMoments& p, double z, const dem::ContactForce& c) {
  const Place middle = place(p, z - 0.5 * c.branch.z);
  cover(p.flow, middle.bin, z);
  deposit_level(p.flow, kContact, middle, 0.5 * c.branch.z, p.lattice.bin(), c.force, c.branch);
}

// sigma_az over everything below grain i, the other components from i to the contact point.
void add_base_contact(ProfileMoments& p, double z, double diameter, const dem::ContactForce& c) {
  const Vec3 arm = arm_from_contact(diameter, c), f = c.force;
  const bool is_level = std::abs(arm.z) < level(p);
  const double x = is_level ? 0 : arm.x / arm.z, y = is_level ? 0 : arm.y / arm.z;
  const Place top = place(p, z), bottom = place(p, z - arm.z), middle = place(p, z - 0.5 * arm.z);
  for (const Place& at : {top, bottom, middle}) cover(p.base, at.bin, z);
  deposit_base(p.base, top, {f.x * x, f.x * y, f.x, f.y * x, f.y * y, f.y, f.z * x, f.z * y, f.z});
  if (is_level)
    deposit_level(p.base, 0, middle, 0.5 * arm.z, p.lattice.bin(), f, arm);
  else
    deposit_base(p.base, bottom, {-f.x * x, -f.x * y, 0, -f.y * x, -f.y * y, 0, -f.z * x, -f.z * y, 0});
  p.base_force -= f;
}

void add_snapshot(ProfileMoments& p, const Snapshot& s, ProfileScratch& scratch) {
  add(
      p, SnapshotGrains{s}, s.flowing, [&](const auto& f) { f(s.contacts); }, scratch);
}

void add_state(ProfileMoments& p, const dem::DemState& state, const dem::ContactLaws& laws, ProfileScratch& scratch) {
  const StateGrains grains{state, state.step == 0 ? 0 : 0.5 * state.dt};
  add(
      p, grains, state.grains.flowing, [&](const auto& f) { dem::for_contact_batches(state, laws, std::ref(f)); },
      scratch);
}

}  // namespace bagnold::cg

// Gathering from inside the fast engine: grains from its rows, contacts from its lists.
#include <array>
#include <numbers>

#include "cg/gather.hpp"
#include "core/simd.hpp"
#include "dem/fast/engine.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::cg {
namespace {

using dem::fast::ContactPack;

template <bool all_alike>
class RowGrains {
 public:
  static constexpr bool alike = all_alike;
  // What follows from the mass and size of a grain; neighbours mostly have the same.
  struct Memo {
    double inverse_mass = 0, inverse_inertia = 0, radius = 0, volume = 0;
    Lanes half_step{}, inertia{}, volumes{};  // dt/2m, dt/2I; m, I; pi d^3/6 and the same times d
  };

  explicit RowGrains(const dem::fast::Engine& engine)
      : position_(engine.rows.position.data()),
        velocity_(engine.rows.velocity.data()),
        force_(engine.rows.force.data()),
        half_(engine.step == 0 ? 0 : 0.5 * engine.dt),
        half_gravity_(half_ * engine.gravity.x, half_ * engine.gravity.y, half_ * engine.gravity.z, 0, 0, 0, 0, 0) {
    if (!alike) return;
    const auto slab = std::find_if(engine.slabs.begin(), engine.slabs.end(),
                                   [](const dem::fast::Slab& s) { return s.begin < s.moving_end; });
    if (slab != engine.slabs.end()) renew(all_, velocity(slab->begin), force(slab->begin));
  }

  double z(std::size_t k) const { return position_[dem::fast::position_doubles * k + 2]; }
  double diameter(std::size_t k) const { return 2 * position_[dem::fast::position_doubles * k + 3]; }

  // Asks for the rows of a grain.
  void ask(std::size_t k) const {
    __builtin_prefetch(velocity(k));
    __builtin_prefetch(force(k));
  }

  [[gnu::always_inline]] void carry(std::size_t k, Memo& memo, Lanes& a, Lanes& b) const {
    const double *v = velocity(k), *f = force(k);
    if constexpr (!alike)
      if (f[3] != memo.inverse_mass || f[7] != memo.inverse_inertia || v[3] != memo.radius) renew(memo, v, f);
    const Lanes one = 1.0;
    const Lanes now = (alike ? all_ : memo).half_step * Lanes::load(f) + (Lanes::load(v) + half_gravity_);
    // { v, 1, omega, 1 } at the time of the positions
    const Lanes motion(simd::shuffle<0, 1, 2, 8, 4, 5, 6, 8>(now.v, one.v));
    a = alike ? motion : memo.inertia * motion;
    b = Lanes(simd::shuffle<0, 0, 0, 1, 1, 2, 8, 8>(motion.v, one.v)) *
        Lanes(simd::shuffle<0, 1, 2, 1, 2, 2, 8, 9>(a.v, (alike ? one : memo.volumes).v));
  }

  Scales scales() const {
    if (!alike) return {};
    const double m = all_.inertia[0], v = all_.volume;
    return {all_.inertia, Lanes(m, m, m, m, m, m, all_.volumes[0], all_.volumes[1]), Lanes(v, v, v, v, v, v, 0, 1)};
  }

 private:
  const double* velocity(std::size_t k) const { return velocity_ + dem::fast::velocity_doubles * k; }
  const double* force(std::size_t k) const { return force_ + dem::fast::force_doubles * k; }

  void renew(Memo& memo, const double* v, const double* f) const {
    const double m = 1 / f[3], I = 1 / f[7], d = 2 * v[3];
    memo.inverse_mass = f[3];
    memo.inverse_inertia = f[7];
    memo.radius = v[3];
    memo.volume = std::numbers::pi / 6 * d * d * d;
    memo.half_step = half_ * Lanes(f[3], f[3], f[3], 0, f[7], f[7], f[7], 0);
    memo.inertia = Lanes(m, m, m, m, I, I, I, I);
    memo.volumes = Lanes(memo.volume, memo.volume * d, 0, 0, 0, 0, 0, 0);
  }

  const double *position_, *velocity_, *force_;
  double half_;
  Lanes half_gravity_;
  Memo all_;
};

// Channels [16, 32) of eight contacts: fabric, nothing, contact stress f_a r_b/r_z.
struct PackShares {
  Lanes low[8], high[8];  // by contact
};

// Rows to columns.
[[gnu::always_inline]] inline void transpose(const Pack (&row)[8], Pack (&column)[8]) {
  const Register in[8] = {row[0].v, row[1].v, row[2].v, row[3].v, row[4].v, row[5].v, row[6].v, row[7].v};
  Register out[8];
  simd::transpose8(in, out);
  for (int k = 0; k < 8; ++k) column[k].v = out[k];
}

// Returns which of the contacts are nearly level; those give their grains f_a r_z/r_z only.
[[gnu::always_inline]] inline std::uint32_t evaluate(const ContactPack& c, double least_height, PackShares& out) {
  const auto of = [](const ContactPack::Vector& v, std::size_t a) { return Pack::load(v[a].data()); };
  const Pack rx = of(c.branch, 0), ry = of(c.branch, 1), rz = of(c.branch, 2), zero = 0.0;
  const Pack fx = of(c.force, 0), fy = of(c.force, 1), fz = of(c.force, 2);
  const Pack nx = of(c.normal, 0), ny = of(c.normal, 1), nz = of(c.normal, 2);
  const Mask is_level = abs(rz) < Pack(least_height);
  const Pack per_z = select(is_level, zero, Pack(1) / rz), x = rx * per_z, y = ry * per_z;
  const Pack low[8] = {nx * nx, nx * ny, nx * nz, ny * ny, ny * nz, nz * nz, zero, fx * x};
  const Pack high[8] = {fx * y, fx, fy * x, fy * y, fy, fz * x, fz * y, fz};
  transpose(low, out.low);
  transpose(high, out.high);
  return to_integer(is_level);
}

dem::ContactForce lane_of(const ContactPack& c, std::size_t k) {
  const auto vector = [k](const ContactPack::Vector& v) { return Vec3{v[0][k], v[1][k], v[2][k]}; };
  return {static_cast<std::int32_t>(c.i[k]),
          static_cast<std::int32_t>(c.j[k]),
          vector(c.branch),
          vector(c.normal),
          vector(c.force),
          c.overlap[k]};
}

void ask_for_shares(const ProfileScratch& w, const ContactPack& c) {
  for (std::size_t k = 0; k < 8; ++k) {
    ask_for_share(w, c.i[k]);
    ask_for_share(w, c.j[k]);
  }
}

// Gives the grains of eight contacts their shares; contacts with the base and those nearly level are put aside.
void share_pack(const ContactPack& c, double least_height, std::vector<dem::ContactForce>& special, ProfileScratch& w) {
  const Lanes opposite(1, 1, 1, 1, 1, 1, 1, -1);
  const Lanes none = 0.0;
  PackShares given;
  const std::uint32_t is_level = evaluate(c, least_height, given);
  for (std::uint32_t left = c.touching; left != 0; left &= left - 1) {
    const auto k = static_cast<std::size_t>(__builtin_ctz(left));
    const std::size_t i = c.i[k], j = c.j[k];
    const bool i_flows = w.flows[i] != 0, j_flows = w.flows[j] != 0;
    if (i_flows && j_flows) {
      share(w, i, given.low[k], given.high[k]);
      share(w, j, opposite * given.low[k], -given.high[k]);
      if ((is_level >> k & 1) != 0) special.push_back(lane_of(c, k));
      continue;
    }
    share(w, i_flows ? i : j, Lanes(simd::shuffle<0, 1, 2, 3, 4, 5, 6, 8>(given.low[k].v, none.v)), none);
    dem::ContactForce contact = lane_of(c, k);
    if (!i_flows) contact = {contact.j, contact.i, -contact.branch, -contact.normal, -contact.force, contact.overlap};
    special.push_back(contact);
  }
}

template <bool alike>
void add(ProfileMoments& p, const dem::fast::Engine& engine, ProfileScratch& w) {
  const RowGrains<alike> grains(engine);
  w.ranges.clear();
  for (const auto& slab : engine.slabs) w.ranges.emplace_back(slab.begin, slab.moving_end);
  sort_by_bin(p, grains, w);
  for (std::size_t s = 0; s < engine.sections.size(); ++s) {
    p.contacts += static_cast<double>(w.contacts[s]);
    for (const dem::ContactForce& c : w.special[s]) {
      const auto i = static_cast<std::size_t>(c.i);
      if (w.flows[static_cast<std::size_t>(c.j)] != 0)
        add_level_contact(p, grains.z(i), c);
      else
        add_base_contact(p, grains.z(i), grains.diameter(i), c);
    }
  }
  deposit_grains(p, grains, w);
  ++p.samples;
}

}  // namespace

void begin_rows(const dem::fast::Engine& engine, ProfileScratch& w) {
  prepare_shares(w, engine.rows.size());
  w.flows.assign(engine.rows.size(), 0);
  for (const auto& slab : engine.slabs)
    std::fill(w.flows.begin() + static_cast<std::ptrdiff_t>(slab.begin),
              w.flows.begin() + static_cast<std::ptrdiff_t>(slab.moving_end), std::uint8_t{1});
  w.special.resize(engine.sections.size());
  w.contacts.resize(engine.sections.size());
}

void add_section(const ProfileMoments& p, std::size_t section, dem::fast::ContactPacks packs, ProfileScratch& w) {
  w.special[section].clear();
  w.contacts[section] = 0;
  const double least_height = level(p);
  if (!packs.empty()) ask_for_shares(w, packs[0]);
  for (std::size_t k = 0; k < packs.size(); ++k) {
    if (k + 1 < packs.size()) ask_for_shares(w, packs[k + 1]);
    w.contacts[section] += __builtin_popcount(packs[k].touching);
    share_pack(packs[k], least_height, w.special[section], w);
  }
}

void add_rows(ProfileMoments& p, const dem::fast::Engine& engine, ProfileScratch& w) {
  engine.alike ? add<true>(p, engine, w) : add<false>(p, engine, w);
}

}  // namespace bagnold::cg

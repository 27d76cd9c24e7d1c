// The force loop against a plain O(N^2) twin that shares no code with it: no list, no pair law, minimum image.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "core/parallel.hpp"
#include "dem/contact_laws.hpp"
#include "dem/contacts.hpp"
#include "helpers.hpp"

namespace bagnold::dem {
namespace {
using testing::bits;
using testing::random_packing;

// Constants of one combination of laws, as numbers.
struct TwinLaws {
  bool per_mass = false, hertz = false, mindlin = false, rolling = false;
};

ContactModel model_of(const TwinLaws& t) {
  PairParameters p;
  if (t.hertz) {
    laws::Hertz h;
    h.young_modulus = 2e6;
    h.poisson_ratio = 0.25;
    h.restitution = 0.7;
    p.normal = h;
  } else {
    laws::Linear l = testing::linear(2e5, t.per_mass ? 60 : 25);
    if (t.per_mass) l.damping_convention = "per_reduced_mass";
    p.normal = l;
  }
  if (t.mindlin) {
    laws::Mindlin m;
    m.poisson_ratio = 0.25;
    m.friction = 0.3;
    p.tangential = m;
  } else {
    laws::LinearHistory l;
    l.tangential_stiffness = 6e4;
    l.tangential_damping = 20;
    l.friction = 0.3;
    p.tangential = l;
  }
  if (t.rolling) p.rolling = laws::SpringSlider{0.2, 0.3};
  return uniform_model({"grain"}, p);
}

using Springs = std::map<std::pair<std::size_t, std::int64_t>, std::pair<Vec3, Vec3>>;  // (i, j): delta_t, theta
struct TwinState {
  std::vector<Vec3> x, v, w, f, q;
  Springs springs;
};

struct TwinNormal {
  double f, c, k;
};
TwinNormal twin_normal(const TwinLaws& t, double delta, double m, double R) {
  if (!t.hertz) return {2e5 * delta, t.per_mass ? 60 * m : 25, 2e5};
  const double E = 2e6 / 2 / (1 - 0.0625), K = 4 * E * std::sqrt(R) / 3;
  const double L = std::log(0.7), alpha = -std::sqrt(5 / (L * L + M_PI * M_PI)) * L;
  return {K * std::pow(delta, 1.5), alpha * std::sqrt(m * K) * std::pow(delta, 0.25), 1.5 * K * std::sqrt(delta)};
}

Vec3 twin_kept(const Vec3& spring, double earlier, double now) {
  return earlier < now ? earlier / now * spring : spring;
}

// What a pair of grains and a grain at a wall have in common. A wall is a still body of infinite size and mass.
struct TwinContact {
  std::int64_t j;  // grain, or -1 - wall
  Vec3 n, vj, wj;
  double delta, dist, m, R, I;
};

void twin_contact(const TwinLaws& t, const DemState& s, TwinState& a, std::size_t i, const TwinContact& c, double dt,
                  Springs& next) {
  const auto& [j, n, vj, wj, delta, dist, m, R, I] = c;
  const double ri = s.grains.diameter[i] / 2, rj = j < 0 ? 0 : s.grains.diameter[at(j)] / 2;
  const Vec3 v = a.v[i] - vj;
  const Vec3 bi = -(ri - delta / 2) * n, bj = (rj - delta / 2) * n;
  const Vec3 vt = v - dot(v, n) * n + cross(a.w[i], bi) - cross(wj, bj);
  auto [spring, roll] = a.springs.contains({i, j}) ? a.springs.at({i, j}) : std::pair<Vec3, Vec3>{};
  const TwinNormal N = twin_normal(t, delta, m, R);
  const TwinNormal before = twin_normal(t, std::max(0.0, delta + dt * dot(v, n)), m, R);
  const double fn = N.f - N.c * dot(v, n);
  const double kt = t.mindlin ? 2 * 0.75 / 1.75 * N.k : 6e4, gt = t.mindlin ? N.c : 20;
  if (t.mindlin) spring = twin_kept(spring, before.k, N.k);
  spring += dt * (vt - dot(spring, v) / dist * n);
  Vec3 ft = -kt * spring - gt * vt;
  if (norm(ft) > 0.3 * std::abs(fn)) {
    ft = 0.3 * std::abs(fn) / norm(ft) * ft;
    spring = -(ft + gt * vt) / kt;
  }
  Vec3 M{};
  if (t.rolling) {
    const Vec3 spin = a.w[i] - wj - dot(a.w[i] - wj, n) * n;
    const double kr = 2.25 * N.k * 0.04 * R * R, limit = 0.2 * R * std::abs(fn);
    roll = twin_kept(roll, before.k, N.k) + dt * spin - dt * dot(twin_kept(roll, before.k, N.k), v) / dist * n;
    if (norm(kr * roll) > limit) {
      roll = limit / norm(kr * roll) * roll;
      M = -kr * roll;
    } else {
      M = -kr * roll - 2 * 0.3 * std::sqrt(I * kr) * spin;
    }
  }
  next[{i, j}] = {spring, roll};
  const Vec3 f = fn * n + ft;
  a.f[i] += f;
  a.q[i] += cross(bi, f) + M;
  if (j < 0) return;
  a.f[at(j)] -= f;
  a.q[at(j)] += cross(bj, -f) - M;
}

void twin_pair(const TwinLaws& t, const DemState& s, TwinState& a, std::size_t i, std::size_t j, double dt,
               Springs& next) {
  const Grains& g = s.grains;
  const Vec3 r = minimum_image(s.box, a.x[i] - a.x[j]);
  const double ri = g.diameter[i] / 2, rj = g.diameter[j] / 2;
  if (ri + rj <= norm(r)) return;
  const bool flows = static_cast<std::int64_t>(j) < g.flowing;
  const double Ii = 1.4 * g.mass[i] * ri * ri, Ij = 1.4 * g.mass[j] * rj * rj;
  const double m = flows ? g.mass[i] * g.mass[j] / (g.mass[i] + g.mass[j]) : g.mass[i];
  twin_contact(t, s, a, i,
               {static_cast<std::int64_t>(j), r / norm(r), a.v[j], a.w[j], ri + rj - norm(r), norm(r), m,
                ri * rj / (ri + rj), flows ? Ii * Ij / (Ii + Ij) : Ii},
               dt, next);
}

void twin_wall(const TwinLaws& t, const DemState& s, TwinState& a, std::size_t i, std::size_t w, double dt,
               Springs& next) {
  const double ri = s.grains.diameter[i] / 2, height = dot(a.x[i] - s.walls[w].point, s.walls[w].normal);
  if (height >= ri) return;
  const double m = s.grains.mass[i];
  twin_contact(
      t, s, a, i,
      {-1 - static_cast<std::int64_t>(w), s.walls[w].normal, {}, {}, ri - height, INFINITY, m, ri, 1.4 * m * ri * ri},
      dt, next);
}

void twin_forces(const TwinLaws& t, const DemState& s, TwinState& a, double dt) {
  a.f.assign(a.x.size(), {});
  a.q.assign(a.x.size(), {});
  Springs next;
  for (std::size_t i = 0; i < static_cast<std::size_t>(s.grains.flowing); ++i) {
    for (std::size_t j = i + 1; j < a.x.size(); ++j) twin_pair(t, s, a, i, j, dt, next);
    for (std::size_t w = 0; w < s.walls.size(); ++w) twin_wall(t, s, a, i, w, dt, next);
  }
  a.springs = next;
}

void twin_steps(const TwinLaws& t, const DemState& s, TwinState& a, int steps) {
  twin_forces(t, s, a, 0);
  for (int n = 0; n < steps; ++n) {
    const double h = n == 0 ? s.dt / 2 : s.dt;
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.grains.flowing); ++i) {
      a.v[i] += h * (a.f[i] / s.grains.mass[i] + s.gravity);
      a.w[i] += h / s.grains.inertia[i] * a.q[i];
      a.x[i] += s.dt * a.v[i];
    }
    twin_forces(t, s, a, s.dt);
  }
}

// A dense polydisperse packing, some of it fixed, a few cells wide, over enough steps for many rebuilds and crossings.
DemState packing(std::uint64_t seed, std::int64_t per_side, bool walls = false) {
  DemState s = random_packing(per_side, 0.92, seed);
  s.grains.flowing -= per_side;
  for (auto i = at(s.grains.flowing); i < s.grains.x.size(); ++i) s.grains.v[i] = s.grains.omega[i] = {};
  s.gravity = {0.4, -0.2, -1};
  s.dt = 5e-5;
  s.skin = 0.02;
  if (!walls) return s;
  const Vec3 tilted = Vec3{0.1, 0, 1} / std::sqrt(1.01);  // between two plates, periodic in y only
  s.walls = {{s.box.origin - Vec3{0, 0, 0.42}, tilted, 0},
             {s.box.origin + Vec3{0, 0, s.box.length.z - 0.5}, {0, 0, -1}, 0}};
  s.box.periodic[0] = s.box.periodic[2] = false;
  return s;
}

class Twin : public ::testing::TestWithParam<int> {};

TEST_P(Twin, AgreesToRoundOff) {
  const int k = GetParam();
  const TwinLaws t{.per_mass = (k & 1) != 0, .hertz = (k & 2) != 0, .mindlin = (k & 4) != 0, .rolling = (k & 8) != 0};
  for (const auto& [per_side, walls, plain] :
       {std::tuple{3, false, true}, {5, false, true}, {5, true, true}, {5, false, false}, {5, true, false}}) {
    DemState s = packing(static_cast<std::uint64_t>(k), per_side, walls);
    const ContactLaws laws = compile(model_of(t), mean_pair_mass(s.grains));
    s.reorder_every = per_side == 5 ? 40 : 0;
    TwinState a{s.grains.x, s.grains.v, s.grains.omega, {}, {}, {}};
    constexpr int steps = 150;
    twin_steps(t, s, a, steps);
    prepare(s, laws);
    plain ? advance_plain(s, laws, steps) : advance(s, laws, steps);
    EXPECT_GE(s.rebuilds, 2);  // the list was made anew at least once on the way
    EXPECT_EQ(walls, !s.wall_contacts.touching.empty());
    const auto list = contacts(s, laws);
    EXPECT_EQ(list.size(), a.springs.size());
    double force_scale = 0, worst_x = 0, worst_v = 0, worst_f = 0, worst_q = 0;
    for (const Vec3& f : a.f) force_scale = std::max(force_scale, norm(f));
    for (std::int64_t i = 0; i < s.grains.flowing; ++i) {
      const auto id = at(s.grains.id[at(i)]);
      worst_x = std::max(worst_x, norm(minimum_image(s.box, s.grains.x[at(i)] - a.x[id])));
      worst_v = std::max(worst_v, norm(s.grains.v[at(i)] - a.v[id]));
      worst_f = std::max(worst_f, norm(s.grains.force[at(i)] - a.f[id]) / force_scale);
      worst_q = std::max(worst_q, norm(s.grains.torque[at(i)] - a.q[id]) / force_scale);
    }
    EXPECT_LT(worst_x, 2e-12);
    EXPECT_LT(worst_v, 1e-9);
    EXPECT_LT(worst_f, 1e-9);
    EXPECT_LT(worst_q, 1e-9);

    std::vector<Vec3> force(s.grains.x.size()), torque(s.grains.x.size());  // the observers' list gives the same sums
    for (const Contact& c : list) {
      force[at(c.i)] += c.force;
      torque[at(c.i)] += c.torque;
      if (c.j < 0) continue;
      force[at(c.j)] -= c.force;
      torque[at(c.j)] += c.torque_j;
    }
    for (std::int64_t i = 0; i < s.grains.flowing; ++i) {
      EXPECT_LT(norm(force[at(i)] - s.grains.force[at(i)]), 1e-12 * force_scale);
      EXPECT_LT(norm(torque[at(i)] - s.grains.torque[at(i)]), 1e-12 * force_scale);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(EveryLaw, Twin, ::testing::Values(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14));

TEST(Bits, DoNotDependOnThreadsObservationOrInterruption) {
  const ContactLaws laws = compile(model_of({.rolling = true}), 0.5);
  const auto run = [&](int threads, bool observe, bool interrupt) {
    const int before = bagnold::threads();
    force_threads(threads);
    DemState s = packing(7, 9);
    s.keep_ledger = true;
    s.reorder_every = 20;
    prepare(s, laws);
    for (int n = 0; n < 6; ++n) {
      advance(s, laws, 8);
      if (observe) {
        EXPECT_GT(energies(s, laws).kinetic(), 0);
        EXPECT_GT(contacts(s, laws).size(), 0U);
      }
      if (interrupt) {  // into a fresh state made from the input, as a resumed run does
        DemState resumed = packing(7, 9);
        resumed.keep_ledger = true;
        resumed.reorder_every = 20;
        auto from = named_arrays(s), to = named_arrays(resumed);
        for (std::size_t k = 0; k < from.size(); ++k)
          std::visit([&](auto* target) { *target = *std::get<decltype(target)>(from[k].array); }, to[k].array);
        s = resumed;
      }
    }
    set_threads(before);
    return bits(s);
  };
  const std::string reference = run(1, false, false);
  EXPECT_EQ(reference, run(2, false, false));
  EXPECT_EQ(reference, run(2, true, false));
  EXPECT_EQ(reference, run(2, false, true));
}

}  // namespace
}  // namespace bagnold::dem

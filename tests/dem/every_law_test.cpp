// What every contact law must do, for every combination that the registries offer: a new law is tested by being listed.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "dem/contact_laws.hpp"
#include "helpers.hpp"

namespace bagnold::dem {
namespace {

// Parameters of a law of which only its fields are known: by their names, else something inside their range.
template <class Law>
Law example(bool dissipative) {
  const std::map<std::string_view, double> known{{"stiffness", 2e5},
                                                 {"damping", dissipative ? 25 : 0},
                                                 {"young_modulus", 2e6},
                                                 {"restitution", dissipative ? 0.8 : 1},
                                                 {"tangential_stiffness", 6e4},
                                                 {"tangential_damping", dissipative ? 10 : 0},
                                                 {"tangential_damping_ratio", dissipative ? 0.5 : 0},
                                                 {"rolling_damping", dissipative ? 0.3 : 0}};
  Law law;
  const bool by_stiffness = std::is_same_v<Law, laws::Linear>;  // (tc, eps) say the same again
  for_each_field<Law>([&](const auto& f) {
    using Member = std::decay_t<decltype(law.*(f.member))>;
    if constexpr (std::is_same_v<Member, double> || std::is_same_v<Member, std::optional<double>>) {
      if (by_stiffness && f.name == "restitution") return;
      if (known.contains(f.name))
        law.*(f.member) = known.at(f.name);
      else if (f.required)
        law.*(f.member) = std::isfinite(f.range.hi) ? 0.5 * (f.range.lo + f.range.hi) : f.range.lo + 1;
    }
  });
  return law;
}

// f(name, compiled laws) for every combination.
template <class F>
void for_every_choice(bool dissipative, F&& f) {
  laws::NormalLaws::for_each([&]<class N>(N) {
    laws::TangentialLaws::for_each([&]<class T>(T) {
      laws::RollingLaws::for_each([&]<class R>(R) {
        const PairParameters p{example<N>(dissipative), example<T>(dissipative), example<R>(dissipative)};
        f(std::string(N::name) + " + " + std::string(T::name) + " + " + std::string(R::name),
          compile(uniform_model({"grain"}, p), 0.5));
      });
    });
  });
}

double random_in(double lo, double hi, std::uint64_t item, std::uint32_t draw) {
  return lo + (hi - lo) * random::uniform(77, random::Stream::test, item, draw);
}
Vec3 random_vector(double size, std::uint64_t item, std::uint32_t draw) {
  return {random_in(-size, size, item, draw), random_in(-size, size, item, draw + 1),
          random_in(-size, size, item, draw + 2)};
}

// Two unlike grains about to meet, seen so that the speed of approach is `approach`.
DemState about_to_meet(std::uint64_t item, double approach, double dt) {
  DemState s;
  s.dt = dt;
  Vec3 n = random_vector(1, item, 0);
  n *= 1 / norm(n);
  const double d1 = random_in(0.6, 1, item, 4), d2 = random_in(0.6, 1, item, 5);
  testing::add_grain(s, 0.5 * (d1 + d2) * (1 + 1e-9) * n, random_vector(1.5 * approach, item, 6),
                     random_vector(4 * approach, item, 9), d1);
  testing::add_grain(s, {}, {}, random_vector(4 * approach, item, 12), d2);
  s.grains.v[0] += (-approach - dot(s.grains.v[0], n)) * n;
  return s;
}

Size size_of(const DemState& s) { return pair_size(s.grains, 0, 1); }

double collision_time(const ContactLaws& laws, const DemState& s) {
  return with_laws(laws, [&](const auto& tables) { return tables.of(0, 0).normal.collision(size_of(s)).time; });
}

void collide(DemState& s, const ContactLaws& laws) {
  prepare(s, laws);
  advance(s, laws, 20);
  for (int n = 0; n < 100 && s.pairs.touching[0]; ++n) advance(s, laws, 50);
  ASSERT_FALSE(s.pairs.touching[0]);
}

TEST(EveryLaw, ObeysTheThirdLawWhicheverGrainIsSeenFirst) {
  for_every_choice(true, [](const std::string& name, const ContactLaws& laws) {
    with_laws(laws, [&](const auto& tables) {
      const auto law = tables.of(0, 0);
      for (std::uint64_t item = 0; item < 20; ++item) {
        DemState s = about_to_meet(item, 1, 1e-4);
        s.grains.x[0] *= 0.99;
        const auto seen = [&](std::size_t i, std::size_t j, double sign) {
          History h{numbers(sign * random_vector(1e-3, item, 20)), numbers(sign * random_vector(1e-3, item, 23))};
          const auto g = laws::pair_geometry(pair_motion(s.grains, i, j, s.grains.x[i] - s.grains.x[j]));
          return std::pair{laws::interact<true>(law, g, pair_size(s.grains, i, j), s.dt, h), h};
        };
        const auto [a, ha] = seen(0, 1, 1);
        const auto [b, hb] = seen(1, 0, -1);
        const double scale = 1e-13 * norm(vec3(a.force));
        EXPECT_LT(norm(vec3(a.force) + vec3(b.force)), scale) << name;
        EXPECT_LT(norm(vec3(a.torque_i) - vec3(b.torque_j)), scale) << name;
        EXPECT_LT(norm(vec3(a.torque_j) - vec3(b.torque_i)), scale) << name;
        EXPECT_LT(norm(vec3(ha.spring) + vec3(hb.spring)), 1e-15) << name;
        EXPECT_LT(norm(vec3(ha.roll) + vec3(hb.roll)), 1e-15) << name;
      }
    });
  });
}

TEST(EveryLaw, ReboundsHeadOnWithTheRestitutionItClaims) {
  for_every_choice(true, [](const std::string& name, const ContactLaws& laws) {
    for (const double speed : {0.3, 2.0}) {
      DemState s = about_to_meet(1, speed, 1);
      s.dt = collision_time(laws, s) / 1000;
      const Vec3 n = s.grains.x[0] / norm(s.grains.x[0]);
      s.grains.v[0] = -speed * n;
      s.grains.omega[0] = s.grains.omega[1] = {};
      collide(s, laws);
      const double rebound = dot(full_step_velocity(s, 0) - full_step_velocity(s, 1), n) / speed;
      const double claimed =
          with_laws(laws, [&](const auto& t) { return t.of(0, 0).normal.collision(size_of(s)).restitution; });
      EXPECT_NEAR(rebound, claimed, 2e-3) << name << " at speed " << speed;
      EXPECT_LT(claimed, 0.95);
    }
  });
}

TEST(EveryLaw, NeverGainsEnergyInACollision) {
  for (const bool dissipative : {false, true})
    for_every_choice(dissipative, [](const std::string& name, const ContactLaws& laws) {
      for (std::uint64_t item = 0; item < 40; ++item) {
        DemState s = about_to_meet(item, random_in(0.2, 1.5, item, 30), 1);
        s.dt = collision_time(laws, s) / 200;
        prepare(s, laws);
        const double before = energies(s, laws).kinetic();
        collide(s, laws);
        EXPECT_LT(energies(s, laws).kinetic(), before * (1 + 2e-4)) << name << ", pair " << item;
      }
    });
}

// Shear lightly pressed, press, shear back, let go, in both orders: a spring that follows the load must not do net work.
TEST(EveryLaw, GivesNoTangentialWorkInALoadingCycle) {
  for_every_choice(false, [](const std::string& name, const ContactLaws& laws) {
    with_laws(laws, [&](const auto& tables) {
      const auto law = tables.of(0, 0);
      const Size size = laws::sizes(2, 2, 1, 1);
      for (const bool reversed : {false, true}) {
        double overlap = 1e-3, work = 0, taken = 0;
        History history{};
        const auto move = [&](double press, double shear) {
          constexpr int steps = 2000;
          for (int n = 0; n < steps; ++n) {
            overlap += press / steps;
            const Motion motion{{0, 0, 1 - overlap}, {shear, 0, -press}, {0, 0, 0}, {0, 0, 0}, 1, 0, 0};
            const Force f = laws::interact<true>(law, laws::pair_geometry(motion), size, 1.0 / steps, history);
            const double power = f.force.x * shear;
            work += power / steps;
            taken -= std::min(0.0, power) / steps;
          }
        };
        if (reversed) move(4e-3, 0);
        move(0, 1e-4);
        move(reversed ? -4e-3 : 4e-3, 0);
        move(0, -1e-4);
        if (!reversed) move(-4e-3, 0);
        EXPECT_GT(taken, 0) << name;
        EXPECT_LT(work, 2e-3 * taken) << name << (reversed ? ", unloaded while sheared" : ", loaded while sheared");
      }
    });
  });
}

TEST(EveryLaw, KeepsItsHistoryOnlyWhileItTouches) {
  for_every_choice(true, [](const std::string& name, const ContactLaws& laws) {
    DemState s = about_to_meet(3, 1, 1);
    s.dt = collision_time(laws, s) / 100;
    collide(s, laws);
    EXPECT_EQ(s.pairs.spring[0], Vec3{}) << name;
    EXPECT_EQ(s.pairs.roll[0], Vec3{}) << name;
  });
}

}  // namespace
}  // namespace bagnold::dem

// The table of contact types and the physical checks.
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "dem/contact_laws.hpp"
#include "helpers.hpp"

namespace bagnold::dem {
namespace {
using testing::add_grain;

// Flowing grains of the paper, a fixed base grain of species 1 and a floor of species 2.
DemState chute_like() {
  DemState s;
  add_grain(s, {0, 0, 2});
  add_grain(s, {2, 0, 2});
  add_grain(s, {0, 0, 0}, {}, {}, 1, 6 / std::numbers::pi, 1);
  s.grains.flowing = 2;
  s.walls = {{{0, 0, -5}, {0, 0, 1}, 2}};
  s.dt = 1e-4;
  return s;
}

ContactModel by_collision(double tc, double eps) {
  laws::Linear law;
  law.collision_time = tc;
  law.restitution = eps;
  return uniform_model({"grain", "base", "floor"}, {law, laws::LinearHistory{}, laws::NoRollingResistance{}});
}

TEST(ContactTypes, ListEveryPairOfSpeciesThatCanMeetAtItsOwnMass) {
  const auto types = contact_types(chute_like(), by_collision(0.005, 0.88));
  ASSERT_EQ(types.size(), 3U);  // grain-grain, grain-base, grain-floor
  EXPECT_DOUBLE_EQ(types[0].reduced_mass, 0.5);
  EXPECT_DOUBLE_EQ(types[1].reduced_mass, 1);
  EXPECT_DOUBLE_EQ(types[2].reduced_mass, 1);
  EXPECT_NEAR(types[0].tc, 0.005, 1e-15);
  EXPECT_NEAR(types[0].restitution, 0.88, 1e-13);
  EXPECT_NEAR(types[0].kn, 2e5, 3e3);  // the paper's rounded constants
  EXPECT_NEAR(types[0].gamma_n, 25, 0.6);
  EXPECT_DOUBLE_EQ(types[0].kt, 2 * types[0].kn / 7);
  EXPECT_DOUBLE_EQ(types[0].gamma_t, types[0].gamma_n);
  EXPECT_NEAR(types[1].tc, 0.005 * std::sqrt(2.0), 1e-5);
}

TEST(ContactTypes, PerReducedMassDampingIsTwiceThePaperConstant) {
  laws::Linear law = testing::linear(2e5, 50);
  law.damping_convention = "per_reduced_mass";
  const auto model =
      uniform_model({"grain", "base", "floor"}, {law, laws::LinearHistory{}, laws::NoRollingResistance{}});
  const auto types = contact_types(chute_like(), model);
  EXPECT_DOUBLE_EQ(types[0].gamma_n, 25);
  EXPECT_DOUBLE_EQ(types[0].gamma_t, 25);
  EXPECT_DOUBLE_EQ(types[1].gamma_n, 50);  // m_ij = 1 against the base
}

TEST(Species, EachPairActsWithItsOwnConstants) {
  ContactModel model = by_collision(0.005, 0.88);
  for (std::int32_t a = 0; a < 3; ++a)
    for (std::int32_t b = a; b < 3; ++b)
      set_pair(model, a, b,
               {testing::linear(1000 * (1 + a + 3 * b), 0), laws::LinearHistory{}, laws::NoRollingResistance{}});
  const ContactLaws laws = compile(model, 0.5);
  const auto force = [&](std::int32_t a, std::int32_t b) {  // b == 2: the wall
    DemState s;
    s.dt = 1e-4;
    add_grain(s, {0, 0, 0.99}, {}, {}, 1, 1, a);
    if (b < 2)
      add_grain(s, {0, 0, 0}, {}, {}, 1, 1, b);
    else
      s.walls = {{{0, 0, 0.5}, {0, 0, 1}, 2}};
    prepare(s, laws);
    return s.grains.force[0].z;
  };
  EXPECT_NEAR(force(0, 0), 10, 1e-11);
  EXPECT_NEAR(force(0, 1), 40, 1e-11);
  EXPECT_NEAR(force(1, 0), 40, 1e-11);
  EXPECT_NEAR(force(1, 1), 50, 1e-11);
  EXPECT_NEAR(force(0, 2), 70, 1e-11);
  EXPECT_NEAR(force(1, 2), 80, 1e-11);
}

TEST(PhysicalChecks, JudgeTheStepAgainstTheCollisionTime) {
  DemState s = chute_like();
  const auto model = by_collision(0.005, 0.88);
  EXPECT_TRUE(physical_findings(s, model).empty());
  s.dt = 0.005 / 15;
  ASSERT_FALSE(physical_findings(s, model).empty());
  EXPECT_FALSE(physical_findings(s, model)[0].error);
  s.dt = 0.005 / 9;
  EXPECT_TRUE(physical_findings(s, model)[0].error);
}

TEST(PhysicalChecks, ReportOverlapsAtTheStart) {
  DemState s = chute_like();
  add_grain(s, {0, 0, 2.4});
  std::swap(s.grains.x[2], s.grains.x[3]);
  std::swap(s.grains.species[2], s.grains.species[3]);
  s.max_overlap_ratio = 1.5;
  prepare(s, compile(by_collision(0.005, 0.88), 0.5));
  s.max_overlap_ratio = 0.5;
  const auto findings = physical_findings(s, by_collision(0.005, 0.88));
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_TRUE(findings[0].error);
  EXPECT_NEAR(max_overlap_over_radius(s), 1.2, 1e-12);
}

TEST(PhysicalChecks, RefuseImpossibleParameters) {
  EXPECT_THROW(compile(by_collision(-1, 0.88), 0.5), UnphysicalError);
  EXPECT_THROW(compile(by_collision(0.005, 1.2), 0.5), UnphysicalError);
  auto model = by_collision(0.005, 0.88);
  std::get<laws::Linear>(model.pairs[0].normal).stiffness = 2e5;  // both ways of saying it
  EXPECT_THROW(compile(model, 0.5), UnphysicalError);
  model = by_collision(0.005, 0.88);
  std::get<laws::Linear>(model.pairs[0].normal).damping_convention = "silbert";
  EXPECT_THROW(compile(model, 0.5), UnphysicalError);
}

TEST(PhysicalChecks, RefuseWallsThatDoNotFitTheBox) {
  DemState s = chute_like();
  const ContactLaws laws = compile(by_collision(0.005, 0.88), 0.5);
  s.box = {{0, 0, 0}, {10, 10, 10}, {true, true, false}};
  prepare(s, laws);
  s.walls[0].normal = {0.6, 0, 0.8};  // x repeats, the plane does not
  EXPECT_THROW(prepare(s, laws), UnphysicalError);
  s.walls[0].normal = {0, 0, 2};
  EXPECT_THROW(prepare(s, laws), UnphysicalError);
}

TEST(NumericalFailure, NamesTheGrainTheStepAndTheCause) {
  const auto laws = testing::paper_laws();
  const auto failure = [&](Vec3 v) {
    DemState s;
    s.dt = 1e-3;
    add_grain(s, {0, 0, 0});
    add_grain(s, {1.05, 0, 0}, v);
    try {
      prepare(s, laws);
      advance(s, laws, 2000);
    } catch (const NumericalError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(failure({-400, 0, 0}).find("overlap"), std::string::npos);
  EXPECT_NE(failure({2000, 0, 0}).find("grain 1 at step 0"), std::string::npos);
  EXPECT_NE(failure({NAN, 0, 0}).find("not finite"), std::string::npos);
}

}  // namespace
}  // namespace bagnold::dem

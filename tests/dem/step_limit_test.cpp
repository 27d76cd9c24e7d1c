// The automatic step: of the pair that needs the shortest one, whatever the sizes and the contact law.
#include "dem/step_limit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "helpers.hpp"

namespace bagnold::dem {
namespace {
using testing::add_grain;

struct Kind {
  const char* name;
  PairParameters pair;
};

// Every normal law and convention, with and without losses.
std::vector<Kind> kinds() {
  laws::Linear collision, elastic = testing::linear(2e5, 0), per_mass = testing::linear(2e5, 50);
  collision.collision_time = 0.005;
  collision.restitution = 0.88;
  per_mass.damping_convention = "per_reduced_mass";
  laws::LinearHistory quarter;
  quarter.tangential_damping = 25;
  laws::Linear soggy = testing::linear(2e5, 120);
  laws::LinearHistory smooth, stiff;
  smooth.friction = 0;
  stiff.tangential_stiffness = 8e6;
  const laws::Hertz hertz{.young_modulus = 1e7, .restitution = 0.7}, bouncy{.young_modulus = 1e7, .restitution = 1};
  const laws::NoRollingResistance none;
  return {{"Collision", {collision, laws::LinearHistory{}, none}},
          {"Elastic", {elastic, smooth, none}},
          {"PerReducedMass", {per_mass, quarter, none}},
          {"Soggy", {soggy, laws::LinearHistory{}, none}},
          {"StiffAlong", {elastic, stiff, none}},
          {"Hertz", {hertz, laws::Mindlin{}, none}},
          {"HertzElastic", {bouncy, laws::Mindlin{.friction = 0}, none}}};
}

class StepLimits : public ::testing::TestWithParam<std::tuple<Kind, double>> {
 protected:
  ContactModel model() const { return uniform_model({"grain", "base"}, std::get<0>(GetParam()).pair); }
  double spread() const { return std::get<1>(GetParam()); }
  bool is(const std::string& name) const { return std::get<0>(GetParam()).name == name; }
};
INSTANTIATE_TEST_SUITE_P(LawsAndSizes, StepLimits,
                         ::testing::Combine(::testing::ValuesIn(kinds()), ::testing::Values(0.0, 0.3, 0.6, 0.9)),
                         [](const auto& p) {
                           return std::string(std::get<0>(p.param).name) +
                                  std::to_string(static_cast<int>(10 * std::get<1>(p.param)));
                         });

double size(double spread, std::uint64_t i) {
  return 1 + spread * (2 * random::uniform(5, random::Stream::test, i) - 1);
}

// Grains of the given sizes that nothing has brought together yet, over a base of two sizes and a floor.
DemState over_base(const std::vector<double>& diameters) {
  DemState s;
  for (const double d : diameters) add_grain(s, {2.0 * static_cast<double>(s.grains.size()), 0, 9}, {}, {}, d);
  for (const double d : {0.4, 1.5}) {
    add_grain(s, {50 * d, 0, 0}, {}, {}, d, 6 / std::numbers::pi, 1);
    --s.grains.flowing;
  }
  s.walls = {{{0, 0, -5}, {0, 0, 1}, 1}};
  return s;
}

TEST_P(StepLimits, IsTheShortestOfAllPairsThatCanMeet) {
  std::vector<double> sizes;
  for (std::uint64_t i = 0; i < 12; ++i) sizes.push_back(size(spread(), i));
  const DemState all = over_base(sizes);
  ContactModel same = model();  // automatic values refer to the mean grain of the whole
  for (PairParameters& p : same.pairs)
    if (auto* law = std::get_if<laws::Linear>(&p.normal); law != nullptr && law->collision_time)
      law->reduced_mass = mean_pair_mass(all.grains);
  double shortest = INFINITY;
  for (std::size_t i = 0; i < sizes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      shortest = std::min(shortest, step_limit(over_base({sizes[i], sizes[j]}), same).step);
  const StepLimit limit = step_limit(all, model());
  EXPECT_NEAR(limit.step / shortest, 1, 1e-9) << to_string(limit);
}

TEST_P(StepLimits, EqualGrainsStepByAFiftiethOfTheirCollision) {
  DemState s;
  for (int i = 0; i < 7; ++i) add_grain(s, {2.0 * i, 0, 0}, {}, {}, 1 + spread());
  const double step = step_limit(s, model()).step, fiftieth = contact_types(s, model())[0].tc / 50;
  if (is("Soggy") || is("StiffAlong"))
    EXPECT_LE(step, fiftieth);  // these follow the dashpot and the tangential spring
  else
    EXPECT_EQ(step, fiftieth);
}

// Two of the smallest grains meet, obliquely and spinning; energies before and after.
struct Meeting {
  double before, after;
};
Meeting meet(const ContactModel& model, double d, double part_of_step) {
  const double v = 0.5;
  DemState s;
  add_grain(s, {0, 0, 0}, {v, 0, 0}, {0, 0, v / d}, d);
  add_grain(s, {0.96 * d, 0.3 * d, 0}, {}, {0, v / d, 0}, d);
  add_grain(s, {50, 0, 0}, {}, {}, 2);
  const ContactLaws laws = compile(model, mean_pair_mass(s.grains));
  s.dt = part_of_step * step_limit(s, model).step;
  prepare(s, laws);
  const Meeting start{energies(s, laws).total(), 0};
  Energies e;
  do {
    advance(s, laws, static_cast<std::int64_t>(50 / part_of_step));
    e = energies(s, laws);
  } while (s.step < 5'000'000 && (e.elastic() > 0 || full_step_velocity(s, 1).x == 0));
  return {start.before, e.total()};
}

TEST_P(StepLimits, ResolvesACollisionOfTheSmallestGrains) {
  const double d = 1 - spread();
  const Meeting m = meet(model(), d, 1), fine = meet(model(), d, 0.2);
  EXPECT_LT(m.after, m.before * (1 + 1e-3));  // nothing appears
  EXPECT_NEAR(m.after / fine.after, 1, 0.03);
  if (is("Elastic") || is("HertzElastic")) {
    EXPECT_NEAR(m.after / m.before, 1, 1e-3);
  } else {
    EXPECT_LT(m.after, 0.99 * m.before) << "they never met";
  }
}

// The recurrence of the integrator, right below and right above the bound.
TEST(StableStep, IsWhereTheIntegratorStartsToGrow) {
  for (const double gamma : {0.0, 25.0, 316.0, 5000.0}) {
    DemState s;
    add_grain(s, {});
    add_grain(s, {2, 0, 0});
    laws::LinearHistory slippery;
    slippery.tangential_stiffness = slippery.tangential_damping = 0.0;
    const auto model = uniform_model({"grain"}, {testing::linear(2e5, gamma), slippery, laws::NoRollingResistance{}});
    const double stable = step_limit(s, model).stable, mass = 0.5;
    const auto grows = [&](double dt) {
      double x = 0, v = 1;
      for (int k = 0; k < 4000; ++k) {
        v -= dt * (2e5 * x + gamma * v) / mass;
        x += dt * v;
      }
      return !(std::abs(x) < 10);
    };
    EXPECT_FALSE(grows(0.99 * stable)) << gamma;
    EXPECT_TRUE(grows(1.01 * stable)) << gamma;
  }
}

TEST(StepFindings, NameThePairThatIsTooFastForTheStep) {
  DemState s;
  add_grain(s, {0, 0, 0}, {}, {}, 0.1);
  add_grain(s, {1, 0, 0}, {}, {}, 0.12);
  add_grain(s, {9, 0, 0}, {}, {}, 2);
  laws::LinearHistory slippery;
  slippery.tangential_stiffness = slippery.tangential_damping = 0.0;
  const auto model = uniform_model({"grain"}, {testing::linear(2e5, 0), slippery, laws::NoRollingResistance{}});
  const StepLimit limit = step_limit(s, model);
  EXPECT_EQ(to_string(limit), "grain-grain, d = 0.1 and 0.12");
  s.dt = limit.tc / 25;
  EXPECT_TRUE(step_findings(s, model).empty());
  s.dt = limit.tc / 15;
  ASSERT_EQ(step_findings(s, model).size(), 1U);
  EXPECT_FALSE(step_findings(s, model)[0].error);
  s.dt = limit.tc / 9;
  ASSERT_EQ(step_findings(s, model).size(), 1U);
  EXPECT_TRUE(step_findings(s, model)[0].error);
  EXPECT_NE(step_findings(s, model)[0].text.find("d = 0.1 and 0.12"), std::string::npos);
}

}  // namespace
}  // namespace bagnold::dem

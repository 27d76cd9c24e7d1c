// The energy balance: figure 15 of Weinhart et al. 2012, and the ledger with everything that takes energy.
#include <gtest/gtest.h>

#include <algorithm>

#include "dem/contacts.hpp"
#include "helpers.hpp"

namespace bagnold::dem {
namespace {
using testing::add_grain;

constexpr double tc = 0.005;

// Largest deviation of total energy plus losses from its first value, relative to that value.
double residual(DemState s, const ContactLaws& laws, int chunks, int steps) {
  prepare(s, laws);
  const double first = energies(s, laws).total() + lost(s.ledger);
  double worst = 0;
  for (int n = 0; n < chunks; ++n) {
    advance(s, laws, steps);
    worst = std::max(worst, std::abs(energies(s, laws).total() + lost(s.ledger) - first));
  }
  return worst / std::abs(first);
}

DemState oblique_pair(double dt) {
  DemState s;
  s.dt = dt;
  s.keep_ledger = true;
  add_grain(s, {0.6, 0.0, 0.8 + 0.3 * dt}, {-0.6, 0.2, -0.3}, {0, 3, 0});
  add_grain(s, {0, 0, 0}, {0.2, 0, 0.5});
  return s;
}

// No dissipation, no sliding. kt = kn/2: with 2/7 kn the tangential spring would swing back to 0 just as the contact
// opens, and there would be no jump.
ContactLaws conservative() {
  laws::LinearHistory tangential;
  tangential.tangential_stiffness = 1e5;
  tangential.friction = INFINITY;
  return compile(uniform_model({"grain"}, {testing::linear(2e5, 0), tangential, laws::NoRollingResistance{}}), 0.5);
}

TEST(Figure15, EnergyIsKeptWithoutDissipationAndSliding) {
  const ContactLaws laws = conservative();
  DemState s = oblique_pair(tc / 50);
  prepare(s, laws);
  const double first = energies(s, laws).total();
  double most_tangential = 0;
  for (int n = 0; n < 100; ++n) {
    advance(s, laws, 1);
    most_tangential = std::max(most_tangential, energies(s, laws).tangential_spring);
  }
  ASSERT_TRUE(contacts(s, laws).empty());
  EXPECT_GT(most_tangential, 0.01 * first);  // the collision is oblique
  EXPECT_GT(s.ledger.opened, 1e-2 * first);  // the jump at the end of contact: internal energy
  EXPECT_EQ(s.ledger.sliding, 0);
  EXPECT_EQ(lost(s.ledger), s.ledger.opened);
  EXPECT_LT(std::abs(energies(s, laws).total() + lost(s.ledger) - first), 1e-3 * first);
}

TEST(Figure15, DriftIsOfSecondOrder) {
  const ContactLaws laws = conservative();
  std::vector<double> r;
  for (const int n : {50, 100, 200, 400}) r.push_back(residual(oblique_pair(tc / n), laws, 2 * n, 1));
  EXPECT_LT(r[0], 1e-3);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(r[k + 1], r[k] / 3) << k;
  std::cout << "drift at tc/50 .. tc/400: " << r[0] << ' ' << r[1] << ' ' << r[2] << ' ' << r[3] << '\n';
}

TEST(Ledger, ClosesForAPairWithDissipationAndSliding) {
  for (const double mu : {0.1, 0.5}) {
    const ContactLaws laws = testing::paper_laws(25, mu);
    std::vector<double> r;
    for (const int n : {50, 100, 200, 400}) r.push_back(residual(oblique_pair(tc / n), laws, 2 * n, 1));
    EXPECT_LT(r[0], 1e-3);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(r[k + 1], r[k] / 3) << k;
  }
}

// Many grains, every sink at work, crossing periodic boundaries under gravity.
TEST(Ledger, ClosesForACrowd) {
  for (const bool hertz : {false, true}) {
    PairParameters p;
    p.rolling = laws::SpringSlider{0.1, 0.3};
    if (hertz) {
      laws::Hertz h;
      h.young_modulus = 4e6;
      p.normal = h;
      p.tangential = laws::Mindlin{};
    } else {
      p.normal = testing::linear(2e5, 25);
      p.tangential = laws::LinearHistory{};
    }
    const ContactLaws laws = compile(uniform_model({"grain"}, p), 0.5);
    std::vector<double> r;
    for (const int n : {50, 200}) {
      DemState s = testing::random_packing(5, 1.02, 3);
      s.gravity = {0.3, 0, -1};
      s.keep_ledger = true;
      s.dt = tc / n;
      r.push_back(residual(s, laws, 20, 4 * n));
    }
    RecordProperty(hertz ? "hertz" : "linear", std::to_string(r[0]));
    EXPECT_LT(r[0], 1e-3);
    EXPECT_LT(r[1], r[0] / 3);
  }
}

}  // namespace
}  // namespace bagnold::dem

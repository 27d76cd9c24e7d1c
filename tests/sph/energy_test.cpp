// The energy ledger: it closes, and it does not touch the flow it watches.
#include "sph/energy.hpp"
#include "helpers.hpp"
#include "sph/observe.hpp"

namespace bagnold::sph::test {
namespace {

struct Ledgered {
  std::string name;
  scenario::ColumnGeometry geometry;
  Model model;
};

std::vector<Ledgered> columns() {
  Model full = improved(Model{});
  full.material.regularisation = laws::regularisation::Minatti2015{795, 1e3};
  Model euler = full;
  euler.stepping = Stepping::explicit_euler;
  euler.material.regularisation = laws::regularisation::Minatti2015{795, 1.2};
  Model printed = Model{};
  printed.numerics.artificial_viscosity = 0.1;
  Model stepped = Model{};
  stepped.stepping = Stepping::implicit;
  Model cone = full;
  cone.material.yield_surface = laws::yield_surface::MatsuokaNakai{};
  return {{"axisymmetric", scenario::ColumnGeometry::axisymmetric, full},
          {"axisymmetric, friction by Lode angle", scenario::ColumnGeometry::axisymmetric, cone},
          {"planar", scenario::ColumnGeometry::planar, full},
          {"explicit", scenario::ColumnGeometry::planar, euler},
          {"printed", scenario::ColumnGeometry::planar, printed},
          {"printed, stepped implicitly", scenario::ColumnGeometry::planar, stepped}};
}

Simulation run(const Ledgered& column, bool keep, double until = 0.05) {
  Simulation r = start(scenario::ContinuumColumn{.radius = 0.024, .height = 0.024, .spacing = 3e-3}, column.geometry,
                       column.model);
  r.state.keep_ledger = keep;
  advance(r, until);
  return r;
}

TEST(EnergyLedger, Closes) {
  for (const Ledgered& column : columns()) {
    SCOPED_TRACE(column.name);
    const Simulation r = run(column, true);
    const Ledger& l = r.state.ledger;
    const double before = potential_energy(run(column, false, 0).state, r.model),
                 released = before - potential_energy(r.state, r.model);
    EXPECT_GT(released, 0.04 * before);
    EXPECT_LT(std::abs(ledger_residual(r.state, r.model)), 1e-12 * before);
    EXPECT_NEAR(l.gravity - l.displaced, released, 1e-12 * before);
    for (const double lost : {l.friction, l.bulk, l.artificial, l.walls}) EXPECT_GE(lost, 0);
  }
}

TEST(EnergyLedger, ChangesNothing) {
  for (const Ledgered& column : columns()) {
    const Simulation with = run(column, true, 0.01), without = run(column, false, 0.01);
    for (std::size_t d : {0u, 1u}) {
      EXPECT_TRUE(with.state.particles.x[d] == without.state.particles.x[d]) << column.name;
      EXPECT_TRUE(with.state.particles.v[d] == without.state.particles.v[d]) << column.name;
    }
    EXPECT_EQ(with.state.force_evaluations, without.state.force_evaluations) << column.name;
  }
}

}  // namespace
}  // namespace bagnold::sph::test

// Dumps that LAMMPS itself wrote (tests/app/lammps): fields of `bagnold cg` against sums over their numbers, and against the
// total forces on the grains, which LAMMPS gives beside the contacts.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "app/cg_input.hpp"
#include "cg/blocks.hpp"

using namespace bagnold;

namespace {

const std::string dumps = BAGNOLD_SOURCE_DIR "/tests/app/lammps/";
constexpr double w = 0.25, theta = 24 * std::numbers::pi / 180, area = 9;
const Vec3 gravity{std::sin(theta), 0, -std::cos(theta)};

double g(double z) { return std::exp(-z * z / (2 * w * w)) / (std::sqrt(2 * std::numbers::pi) * w); }
double phi(double z) { return 0.5 * std::erfc(-z / w / std::numbers::sqrt2); }

// The numbers below the last line of each instant that begins with "ITEM: ".
std::vector<std::vector<std::vector<double>>> instants(const std::string& file) {
  std::ifstream in(dumps + file);
  std::vector<std::vector<std::vector<double>>> out;
  bool rows = false;
  for (std::string text; std::getline(in, text);) {
    if (text.starts_with("ITEM:")) {
      rows = text.starts_with("ITEM: ATOMS") || text.starts_with("ITEM: ENTRIES");
      if (rows) out.emplace_back();
    } else if (rows) {
      std::istringstream words(text);
      std::vector<double>& row = out.back().emplace_back();
      for (double v; words >> v;) row.push_back(v);
    }
  }
  return out;
}

struct Atom {
  bool flows = false;
  Vec3 x, v, force;
  double mass = 0;
};

std::vector<Atom> by_id(const std::vector<std::vector<double>>& rows) {  // id type x v omega radius mass f
  std::vector<Atom> atoms(rows.size() + 1);
  for (const auto& r : rows)
    atoms[static_cast<std::size_t>(r[0])] = {
        r[1] == 1, {r[2], r[3], r[4]}, {r[5], r[6], r[7]}, {r[13], r[14], r[15]}, r[12]};
  return atoms;
}

// Mass, momentum, flux zz, sigma_az of contacts and base, and the force that grains carry, at height z.
struct Sums {
  double rho = 0, flux_zz = 0;
  Vec3 p, contact, base, carried;
};

Sums sums_at(double z, const std::vector<Atom>& atoms, const std::vector<std::vector<double>>& contacts) {
  Sums s;
  for (const Atom& a : atoms) {
    if (!a.flows) continue;
    const double W = g(z - a.x.z) / area;
    s.rho += a.mass * W;
    s.flux_zz += a.mass * a.v.z * a.v.z * W;
    s.p += a.mass * W * a.v;
    s.carried += W * a.force;
  }
  for (const auto& c : contacts) {  // id1 id2, normal and tangential force on id1
    const Atom &one = atoms[static_cast<std::size_t>(c[0])], &two = atoms[static_cast<std::size_t>(c[1])];
    const Vec3 f{c[2] + c[5], c[3] + c[6], c[4] + c[7]};
    if (one.flows && two.flows)  // f_a r_z/r_z, z is not periodic
      s.contact += (phi(z - one.x.z) - phi(z - two.x.z)) / area * f;
    else
      s.base += (phi(z - (one.flows ? one : two).x.z) - 1) / area * (one.flows ? f : -f);
  }
  return s;
}

}  // namespace

TEST(LammpsDump, OfLammpsGivesTheFieldsOfItsNumbers) {
  const auto atoms = instants("atoms.dump"), contacts = instants("contacts.dump");
  ASSERT_EQ(atoms.size(), 2u);
  ASSERT_EQ(contacts.size(), 2u);
  cg::BlockedProfile profile(laws::CgGaussian{w}, w / 4, Box{{0, 0, -2}, {3, 3, 10}, {true, true, false}});
  app::read_instants(
      {dumps + "atoms.dump", dumps + "contacts.dump"},
      {.base_types = {2}, .timestep = 1e-3, .contact_columns = {"id1", "id2", "fx", "fy", "fz", "tx", "ty", "tz"}},
      [&](const cg::StoredSnapshot& s) { profile.add(s.view()); });
  const cg::MeanProfile mean = profile.mean();
  EXPECT_EQ(mean.samples, 2);
  EXPECT_DOUBLE_EQ(mean.begin, 0.4);
  EXPECT_DOUBLE_EQ(mean.end, 0.6);
  double largest = 0;
  for (std::size_t n = 0; n < mean.z.size(); ++n) {
    Sums s;
    for (std::size_t k = 0; k < 2; ++k) {
      const Sums one = sums_at(mean.z[n], by_id(atoms[k]), contacts[k]);
      s.rho += 0.5 * one.rho;
      s.flux_zz += 0.5 * one.flux_zz;
      s.p += 0.5 * one.p;
      s.contact += 0.5 * one.contact;
      s.base += 0.5 * one.base;
      s.carried += 0.5 * one.carried;
    }
    const cg::Row &value = mean.value[n], &slope = mean.slope[n];
    EXPECT_NEAR(value[cg::kMass], s.rho, 1e-9);
    EXPECT_NEAR(value[cg::kFlux + 5], s.flux_zz, 1e-9);
    for (int a = 0; a < 3; ++a) {
      const auto k = static_cast<std::size_t>(a);
      EXPECT_NEAR(value[cg::kMomentum + k], s.p[a], 1e-9);
      EXPECT_NEAR(value[cg::kContact + 3 * k + 2], s.contact[a], 1e-9) << a << " at " << mean.z[n];
      EXPECT_NEAR(value[cg::kBase + 3 * k + 2], s.base[a], 1e-9) << a << " at " << mean.z[n];
      // What LAMMPS added up itself: the stress carries the force on the grains.
      EXPECT_NEAR(slope[cg::kContact + 3 * k + 2] + slope[cg::kBase + 3 * k + 2] + value[cg::kMass] * gravity[a],
                  s.carried[a], 1e-8);
      largest = std::max(largest, std::abs(s.carried[a]));
    }
  }
  EXPECT_GT(largest, 1);
}

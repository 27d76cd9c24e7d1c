// The same instants as own files, as LAMMPS dumps and as MercuryDPM files give the profiles of streaming.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "app/cg_input.hpp"
#include "app/dem_output.hpp"
#include "cg/from_dem.hpp"
#include "core/error.hpp"
#include "core/random.hpp"
#include "dem/contacts.hpp"
#include "io/files.hpp"
#include "io/hdf5.hpp"

using namespace bagnold;
namespace fs = std::filesystem;

namespace {

constexpr double density = 6 / std::numbers::pi;

class StoredRuns : public testing::Test {
 protected:
  void SetUp() override {
    dir = fs::temp_directory_path() / ("bagnold-cg-" + std::to_string(::getpid()));
    fs::remove_all(dir);
    fs::create_directories(dir);
    make_state();
    dem::prepare(state, laws);
    auto file = io::H5File::create(dir / "run.h5");
    for (int k = 0; k < 4; ++k) {
      dem::advance(state, laws, 250);
      record(file, k);
    }
    file.close();
    io::write_file(dir / "atoms.dump", atoms);
    io::write_file(dir / "contacts.dump", entries);
    io::write_file(dir / "chute.data", data);
    io::write_file(dir / "chute.fstat", fstat);
  }
  void TearDown() override { fs::remove_all(dir); }

  // Grains above a layer of fixed ones, shifted so that some pairs touch across the seam.
  void make_state() {
    state.box = {.origin = {0, 0, 0}, .length = {3, 3, 1}, .periodic = {true, true, false}};
    state.gravity = {0.4, 0, -0.9};
    state.dt = 2e-4;
    std::uint64_t item = 0;
    const auto u = [&](std::uint32_t k) { return 2 * random::uniform(8, random::Stream::test, item, k) - 1; };
    for (int k = 0; k < 5; ++k)
      for (int n = 0; n < 9; ++n, ++item) {
        dem::Grains& g = state.grains;
        const bool fixed = k == 4;
        g.x.push_back({n % 3 + 0.1 + 0.01 * u(0), n / 3 + 0.2 + 0.01 * u(1), fixed ? -0.52 + 0.05 * u(2) : k + 0.45});
        g.v.push_back(fixed ? Vec3{} : Vec3{u(3), u(4), u(5)});
        g.omega.push_back({});
        const double d = 0.995;
        g.diameter.push_back(d);
        g.mass.push_back(density * std::numbers::pi / 6 * d * d * d);
        g.inertia.push_back(0.1 * g.mass.back() * d * d);
        g.species.push_back(fixed ? 1 : 0);
        g.id.push_back(static_cast<std::int64_t>(item));
        if (!fixed) ++g.flowing;
      }
    laws::Linear normal;
    normal.stiffness = 2000;
    normal.damping = 2;
    laws = dem::compile(
        dem::uniform_model({"grain", "base"}, {normal, laws::LinearHistory{}, laws::NoRollingResistance{}}), 0.5);
  }

  void record(io::H5File& file, int k) {
    const cg::Snapshot s = cg::snapshot_of(state, laws, scratch);
    streamed.add(s);
    const std::string group = fmt::format("snapshots/{:06}", k);
    file.attribute(group, "t", state.time());
    std::vector<dem::Contact> contacts;
    dem::list_contacts(state, laws, contacts);
    app::write_dem_snapshot(file, group, state, contacts);
    const std::size_t n = s.x.size();
    atoms += fmt::format(
        "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS pp pp ff\n0 3\n0 3\n-1 9\nITEM: ATOMS id type "
        "x y z vx vy vz omegax omegay omegaz radius mass\n",
        state.step, n);
    data += fmt::format("{} {} 0 0 -1 3 3 9\n", n, state.time());
    for (std::size_t a = 0; a < n; ++a) {
      const std::size_t i = n - 1 - a;  // not in the order of ids
      const Vec3 x = wrap(state.box, s.x[i]);
      atoms += fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {}\n", i + 1,
                           i < static_cast<std::size_t>(s.flowing) ? 1 : 2, x.x, x.y, x.z, s.v[i].x, s.v[i].y, s.v[i].z,
                           s.omega[i].x, s.omega[i].y, s.omega[i].z, 0.5 * s.diameter[i], s.mass[i]);
      const Vec3 y = wrap(state.box, s.x[a]);
      data += fmt::format("{} {} {} {} {} {} {} 0 0 0 {} {} {} {}\n", y.x, y.y, y.z, s.v[a].x, s.v[a].y, s.v[a].z,
                          0.5 * s.diameter[a], s.omega[a].x, s.omega[a].y, s.omega[a].z,
                          a < static_cast<std::size_t>(s.flowing) ? 0 : 1);
    }
    entries += fmt::format(
        "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ENTRIES\n{}\nITEM: BOX BOUNDS pp pp ff\n0 3\n0 3\n-1 9\nITEM: ENTRIES "
        "index c_1[1] c_1[2] c_2[1] c_2[2] c_2[3]\n",
        state.step, s.contacts.size());
    fstat += fmt::format("# {} 0\n# 0 0 -1 3 3 9\n# 0.5 0.5 0 0 0 0\n", state.time());
    int row = 0;
    for (const dem::Contact& c : s.contacts) {
      entries += fmt::format("{} {} {} {} {} {}\n", ++row, c.i + 1, c.j + 1, c.force.x, c.force.y, c.force.z);
      const double fn = dot(c.force, c.normal);
      const Vec3 tangential = c.force - fn * c.normal;
      const double ft = norm(tangential);
      const Vec3 t = ft > 0 ? tangential / ft : Vec3{};
      const auto line = [&](int i, int j, const Vec3& normal, const Vec3& along) {
        fstat += fmt::format("{} {} {} 0 0 0 {} 0 {} {} {} {} {} {} {} {}\n", state.time(), i, j, c.overlap, fn, ft,
                             normal.x, normal.y, normal.z, along.x, along.y, along.z);
      };
      line(c.i, c.j, c.normal, t);
      if (c.j < s.flowing) line(c.j, c.i, -c.normal, -t);  // once for each free particle
    }
  }

  cg::MeanProfile profile_of(const std::vector<fs::path>& inputs) {
    cg::BlockedProfile profile(kernel, 0.1, state.box);
    app::read_instants(inputs, {.base_types = base_types, .density = density, .timestep = state.dt},
                       [&](const cg::StoredSnapshot& s) { profile.add(s.view()); });
    return profile.mean();
  }

  void expect_same(const cg::MeanProfile& p) {
    const cg::MeanProfile expected = streamed.mean();
    ASSERT_EQ(p.samples, expected.samples);
    EXPECT_NEAR(p.begin, expected.begin, 1e-12);
    ASSERT_EQ(p.z, expected.z);
    cg::Row peak{};
    for (const cg::Row& row : expected.value)
      for (std::size_t c = 0; c < cg::kChannels; ++c) peak[c] = std::max(peak[c], std::abs(row[c]));
    EXPECT_GT(peak[cg::kContact + 8], 0);
    EXPECT_GT(peak[cg::kBase + 8], 0);
    for (std::size_t n = 0; n < p.z.size(); ++n)
      for (std::size_t c = 0; c < cg::kChannels; ++c)
        EXPECT_NEAR(p.value[n][c], expected.value[n][c], 1e-10 * peak[c]) << "channel " << c;
  }

  fs::path dir;
  dem::DemState state;
  dem::ContactLaws laws;
  cg::DemScratch scratch;
  laws::CgKernels::Any kernel = laws::CgGaussian{0.3};
  cg::BlockedProfile streamed{kernel, 0.1, Box{{0, 0, 0}, {3, 3, 1}, {true, true, false}}};
  std::vector<std::int64_t> base_types;
  std::string atoms, entries, data, fstat;
};

}  // namespace

TEST_F(StoredRuns, OwnFilesGiveTheStreamedProfile) { expect_same(profile_of({dir})); }

TEST_F(StoredRuns, LammpsDumpsGiveTheStreamedProfile) {
  base_types = {2};
  expect_same(profile_of({dir / "atoms.dump", dir / "contacts.dump"}));
}

TEST_F(StoredRuns, MercuryFilesGiveTheStreamedProfile) {
  base_types = {1};
  expect_same(profile_of({dir / "chute.data"}));
}

TEST_F(StoredRuns, FilesThatDoNotFitAreRefused) {
  EXPECT_THROW(profile_of({dir / "atoms.dump"}), InputError);
  EXPECT_THROW(profile_of({dir / "contacts.dump", dir / "atoms.dump"}), InputError);
  EXPECT_THROW(profile_of({dir / "nothing"}), InputError);
  io::write_file(dir / "notes.txt", "hello");
  EXPECT_THROW(profile_of({dir / "notes.txt"}), InputError);
  fs::remove(dir / "chute.fstat");
  EXPECT_THROW(profile_of({dir / "chute.data"}), IoError);
  io::write_file(dir / "broken.dump", atoms.substr(0, atoms.rfind("ITEM: ATOMS") + 100));  // ends in a snapshot
  EXPECT_THROW(profile_of({dir / "broken.dump", dir / "contacts.dump"}), InputError);
}

// Forces on id2 instead of id1 would turn every stress round; attraction on the whole gives it away.
TEST_F(StoredRuns, SwappedPartnersAreNoticed) {
  EXPECT_THROW(
      app::read_instants(
          {dir / "atoms.dump", dir / "contacts.dump"},
          {.base_types = {2}, .density = density, .timestep = 1, .contact_columns = {"id2", "id1", "fx", "fy", "fz"}},
          [](const cg::StoredSnapshot&) {}),
      InputError);
}

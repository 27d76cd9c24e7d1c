// Pictures of layers: run directories made up here, in one and two dimensions.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core/error.hpp"
#include "io/csv.hpp"
#include "io/files.hpp"
#include "io/gnuplot.hpp"
#include "io/hdf5.hpp"
#include "io/json.hpp"
#include "report/layer_pictures.hpp"
#include "report/report.hpp"

namespace bagnold::report {
namespace {

namespace fs = std::filesystem;

class Layers : public testing::Test {
 protected:
  void SetUp() override {
    root = fs::temp_directory_path() / ("bagnold-layers-" + std::to_string(::getpid()));
    fs::remove_all(root);
    fs::create_directories(root);
  }
  void TearDown() override { fs::remove_all(root); }

  void start(const std::string& name, const std::string& model, const std::string& scenario) const {
    fs::create_directories(root / name);
    io::write_file(root / name / "case.toml", "model = \"" + model + "\"\n");
    nlohmann::ordered_json summary;
    summary["model"] = model;
    summary["scenario"] = scenario;
    summary["status"] = "completed";
    summary["time"] = 2.0;
    io::write_json(root / name / "summary.json", summary);
    io::write_csv(root / name / "series.csv",
                  {{"t", "", ""}, {"front", "", ""}, {"tail", "", ""}, {"gauge0_h", "", ""}},
                  {{0, 1, 2}, {2, 3, 4}, {1, 2, 3}, {0, 0.5, 1}});
  }

  // A box of thickness 1 and length 2 that moves right with speed 1, on nx cells over [0, 8].
  void layer(const std::string& name, std::size_t nx, std::size_t ny) const {
    start(name, "shallow", "incline");
    auto file = io::H5File::create(root / name / "run.h5");
    const double dx = 8.0 / static_cast<double>(nx);
    const io::Dims dims{ny, nx};
    std::vector<double> bed(nx * ny), zero(nx * ny, 0.0), arrival(nx * ny, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 0; k < bed.size(); ++k) bed[k] = ny > 1 ? 0.1 * static_cast<double>(k % nx + k / nx) : 0.0;
    file.write("grid/bed", bed, dims);
    file.write("grid/x0_y0_dx_dy", std::vector<double>{0, 0, dx, dx});
    for (int s = 0; s < 3; ++s) {
      std::vector<double> h = zero, u = zero, mass = zero;
      for (std::size_t k = 0; k < h.size(); ++k) {
        const double x = (static_cast<double>(k % nx) + 0.5) * dx;
        if (x < 1 + s || x > 3 + s) continue;
        h[k] = 1;
        u[k] = 1;
        mass[k] = 1.5;
        if (std::isnan(arrival[k])) arrival[k] = s;
      }
      const std::string group = "snapshots/00000" + std::to_string(s);
      file.write(group + "/h", h, dims);
      file.write(group + "/u", u, dims);
      file.write(group + "/v", zero, dims);
      file.write(group + "/mass", mass, dims);
      file.write(group + "/max_h", h, dims);
      file.write(group + "/max_speed", u, dims);
      file.write(group + "/arrival", arrival, dims);
      file.attribute(group, "t", static_cast<double>(s));
    }
    file.close();
  }

  // The same as grains of mass 1/4 in a periodic box 8 x 2: eight rows of four.
  void grains(const std::string& name) const {
    start(name, "dem", "avalanche");
    auto file = io::H5File::create(root / name / "run.h5");
    for (int s = 0; s < 3; ++s) {
      std::vector<Vec3> x, v;
      for (int k = 0; k < 24; ++k) {
        x.push_back({1 + s + (k + 0.5) / 12.0 + (k % 3 == 0 ? 8.0 : 0.0), 0.5, 0.5});  // some in the next period
        v.push_back({1, 0, 0});
      }
      x.push_back({4, 1, -0.5});  // of the base
      v.push_back({0, 0, 0});
      const std::string group = "snapshots/00000" + std::to_string(s);
      file.write(group + "/grains/x", x);
      file.write(group + "/grains/v", v);
      file.write(group + "/grains/diameter", std::vector<double>(x.size(), 0.5));
      file.write(group + "/grains/mass", std::vector<double>(x.size(), 0.25));
      file.write(group + "/grains/box", std::vector<double>{0, 0, 0, 8, 2, 2, 1, 1, 0});
      file.attribute(group + "/grains", "flowing", 24);
      file.attribute(group, "t", static_cast<double>(s));
    }
    file.close();
  }

  LayerFile open(const std::string& name, const std::string& model, const std::string& scenario) const {
    return std::move(*LayerFile::open(root / name, model, scenario));
  }

  bool drawn(const std::string& name) const {
    return fs::exists(root / "figures" / (name + ".svg")) && fs::exists(root / "figures" / (name + ".png"));
  }

  std::string error_of_report(const std::string& name) const {
    try {
      write_report({root / name}, root / "report.html");
    } catch (const IoError& error) {
      return error.what();
    }
    return {};
  }

  fs::path root;
};

TEST_F(Layers, OneDimensionGivesProfilesAndAnXTDiagram) {
  ASSERT_TRUE(io::have_gnuplot()) << "scripts/install-deps.sh installs it";
  layer("line", 40, 1);
  write_report({root / "line"}, root / "report.html", {"png"});
  for (const char* name : {"profiles", "x_t", "front", "gauge_thickness"}) EXPECT_TRUE(drawn(name)) << name;
  EXPECT_FALSE(drawn("max_thickness"));
  const auto html = io::read_file(root / "report.html");
  EXPECT_NE(html.find("alt=\"x_t\""), std::string::npos);
}

TEST_F(Layers, TwoDimensionsGiveMapsAndSections) {
  ASSERT_TRUE(io::have_gnuplot()) << "scripts/install-deps.sh installs it";
  layer("plane", 20, 10);
  write_report({root / "plane"}, root / "report.html", {"png"});
  for (const char* name : {"thickness_in_time", "max_thickness", "max_speed", "arrival", "sections"})
    EXPECT_TRUE(drawn(name)) << name;
  EXPECT_FALSE(drawn("x_t"));
}

TEST_F(Layers, MissingDataIsNamed) {
  layer("line", 40, 1);
  {
    auto file = io::H5File::append(root / "line" / "run.h5");
    file.remove("snapshots/000001/mass");
  }
  EXPECT_NE(error_of_report("line").find("snapshots/000001/mass"), std::string::npos) << error_of_report("line");
  {
    auto file = io::H5File::append(root / "line" / "run.h5");
    file.remove("grid/bed");
  }
  EXPECT_NE(error_of_report("line").find("grid/bed"), std::string::npos) << error_of_report("line");
  io::H5File::create(root / "line" / "run.h5").close();
  EXPECT_NE(error_of_report("line").find("no snapshots"), std::string::npos) << error_of_report("line");
  fs::remove(root / "line" / "run.h5");
  EXPECT_NE(error_of_report("line").find("run.h5"), std::string::npos) << error_of_report("line");
}

TEST_F(Layers, GrainsAreBinnedWithTheirMassAndVelocity) {
  grains("grains");
  const LayerFile file = open("grains", "dem", "avalanche");
  const Layer layer = file.read(1);
  EXPECT_EQ(file.grid().nx, 8u);  // two diameters
  const double sum = std::accumulate(layer.mass.begin(), layer.mass.end(), 0.0) * file.grid().dx * file.grid().dy;
  EXPECT_NEAR(sum, 6, 1e-12);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(layer.mass[i], i == 2 || i == 3 ? 1.5 : 0, 1e-12) << i;
    EXPECT_EQ(layer.u[i], i == 2 || i == 3 ? 1 : 0) << i;
  }
}

TEST_F(Layers, RunsOfDifferentGridsAreComparedOnTheCoarsest) {
  grains("grains");
  layer("fine", 40, 1);
  const LayerFile a = open("grains", "dem", "avalanche"), b = open("fine", "shallow", "incline");
  const Comparison c = compare({{"grains", &a, nullptr}, {"fine", &b, nullptr}});
  ASSERT_EQ(c.x.size(), 8u);
  ASSERT_EQ(c.t.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(c.mass[0][k][i], c.mass[1][k][i], 1e-12) << k << ' ' << i;
  for (const auto& run : c.where)
    for (std::size_t q = 0; q < Comparison::shares.size(); ++q)
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(run[q][k], 1 + static_cast<double>(k) + 2 * Comparison::shares[q], 1e-12) << q << ' ' << k;

  ASSERT_TRUE(io::have_gnuplot()) << "scripts/install-deps.sh installs it";
  write_report({root / "grains", root / "fine"}, root / "report.html", {"png"});
  for (const char* name : {"compared", "profiles_fine", "profiles_grains"}) EXPECT_TRUE(drawn(name)) << name;
  const auto table = io::read_csv(root / "figures" / "compared.csv");
  EXPECT_EQ(table.names, (std::vector<std::string>{"t", "x", "mass_grains", "u_grains", "mass_fine", "u_fine"}));
  EXPECT_EQ(table.rows(), 24u);
}

TEST(Pictures, FirstAndLastSnapshotAreShown) {
  EXPECT_EQ(chosen(1, 6), (std::vector<std::size_t>{0}));
  EXPECT_EQ(chosen(3, 6), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(chosen(11, 6), (std::vector<std::size_t>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(chosen(100, 4).back(), 99u);
}

}  // namespace
}  // namespace bagnold::report

#include "report/report.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "core/error.hpp"
#include "io/files.hpp"
#include "io/gnuplot.hpp"
#include "io/hdf5.hpp"
#include "io/json.hpp"
#include "report/figures.hpp"

namespace bagnold::report {
namespace {

namespace fs = std::filesystem;

// A directory with a made-up chute run whose profile is Bagnold's and whose stress is lithostatic.
class Report : public testing::Test {
 protected:
  void SetUp() override {
    root = fs::temp_directory_path() / ("bagnold-report-" + std::to_string(::getpid()));
    fs::remove_all(root);
    fs::create_directories(root / "steady");
    io::write_file(root / "steady" / "case.toml", "model = \"dem\"  # <angle> & all\n");
    io::write_json(root / "steady" / "summary.json", nlohmann::ordered_json{{"version", "0.1.0"},
                                                                            {"model", "dem"},
                                                                            {"scenario", "chute"},
                                                                            {"status", "completed"},
                                                                            {"time", 100.0},
                                                                            {"flow",
                                                                             {{"h", h},
                                                                              {"base", 0.0},
                                                                              {"u_bar", mean},
                                                                              {"u_bar_err", 0.01},
                                                                              {"theta_deg", 24.0},
                                                                              {"gravity_normal", 0.9},
                                                                              {"alpha", nullptr}}}});
    const std::vector<io::Column> profile{{"z", "d", ""},       {"u_x", "", ""}, {"rho", "", ""},
                                          {"sigma_zz", "", ""}, {"mu", "", ""},  {"grad_u_xz", "", ""}};
    std::vector<std::vector<double>> cells(6);
    for (int k = 0; k <= 20; ++k) {
      const double z = h * k / 20;
      const std::vector<double> row{z,     5.0 / 3 * mean * (1 - std::pow(1 - z / h, 1.5)),
                                    1.1,   1.1 * 0.9 * (h - z),
                                    0.445, 2.5 * mean / h * std::sqrt(1 - z / h)};
      for (std::size_t c = 0; c < 6; ++c) cells[c].push_back(row[c]);
    }
    io::write_csv(root / "steady" / "profile.csv", profile, cells, io::CsvHeader::names_and_units);
    io::write_csv(root / "steady" / "series.csv", {{"t", "", ""}, {"energy_ratio", "", ""}, {"other", "", ""}},
                  {{0, 1, 2}, {0, 10, 20}, {1, 2, 3}});
  }
  void TearDown() override { fs::remove_all(root); }

  const Figure* find(const std::vector<Figure>& all, const std::string& name) const {
    for (const auto& figure : all)
      if (figure.name == name) return &figure;
    return nullptr;
  }

  fs::path root;
  static constexpr double h = 10, mean = 2;
};

TEST_F(Report, ReferenceCurvesMeetTheirTheory) {
  const std::vector<RunData> runs{read_run(root / "steady")};
  const auto all = figures(runs);
  const auto* velocity = find(all, "velocity");
  ASSERT_NE(velocity, nullptr);
  ASSERT_EQ(velocity->curves.size(), 2u);
  const auto& bagnold = velocity->curves[1];
  double integral = 0;  // its mean is the mean velocity it was made of
  for (std::size_t k = 1; k < bagnold.x.size(); ++k)
    integral += 0.5 * (bagnold.x[k] + bagnold.x[k - 1]) * (bagnold.y[k] - bagnold.y[k - 1]);
  EXPECT_NEAR(integral / h, mean, 1e-3 * mean);

  const auto* stress = find(all, "stress");
  ASSERT_NE(stress, nullptr);
  ASSERT_EQ(stress->curves.size(), 2u);
  for (std::size_t k = 0; k < stress->curves[0].x.size(); ++k)
    EXPECT_NEAR(stress->curves[0].x[k], stress->curves[1].x[k], 1e-12 * h);

  EXPECT_NEAR(find(all, "friction")->curves[1].x[0], std::tan(24 * M_PI / 180), 1e-15);

  const auto* strain = find(all, "strain");
  ASSERT_NE(strain, nullptr);
  ASSERT_EQ(strain->curves.size(), 2u);
  for (std::size_t k = 0; k < strain->curves[0].x.size(); ++k)  // both are Bagnold's, at other heights
    EXPECT_NEAR(strain->curves[0].x[k], 2.5 * std::sqrt(1 - strain->curves[0].y[k]), 1e-12);
}

TEST_F(Report, LogarithmicAxesGetNoZeros) {
  const std::vector<RunData> runs{read_run(root / "steady")};
  const auto all = figures(runs);
  const auto* ratio = find(all, "energy_ratio");
  ASSERT_NE(ratio, nullptr);
  EXPECT_TRUE(std::isnan(ratio->curves[0].y[0]));
  EXPECT_EQ(ratio->curves[0].y[2], 20);
  EXPECT_EQ(find(all, "other"), nullptr);
}

TEST_F(Report, AnUnknownSeriesIsDrawnColumnByColumn) {
  io::write_csv(root / "steady" / "series.csv", {{"t", "", ""}, {"volume", "", ""}}, {{0, 1}, {5, 6}});
  fs::remove(root / "steady" / "profile.csv");
  const std::vector<RunData> runs{read_run(root / "steady")};
  const auto all = figures(runs);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].name, "volume");
  EXPECT_EQ(all[0].curves[0].y, (std::vector<double>{5, 6}));
}

TEST_F(Report, WidthsAndSteadinessAreDrawnWhenTheyWereMeasured) {
  const std::vector<RunData> without{read_run(root / "steady")};
  EXPECT_EQ(find(figures(without), "widths"), nullptr);
  io::write_csv(root / "steady" / "widths.csv", {{"z", "", ""}, {"phi_w0.05", "", ""}, {"phi_w1", "", ""}},
                {{0, 1}, {0.5, 0.6}, {0.55, 0.55}}, io::CsvHeader::names_and_units);
  io::write_csv(root / "steady" / "steadiness.csv", {{"duration", "", ""}, {"residual", "", ""}},
                {{1, 10}, {0.1, 0.01}}, io::CsvHeader::names_and_units);
  const std::vector<RunData> with{read_run(root / "steady")};
  const auto all = figures(with);
  ASSERT_NE(find(all, "widths"), nullptr);
  EXPECT_EQ(find(all, "widths")->curves[1].label, "w = 1");
  ASSERT_NE(find(all, "steadiness"), nullptr);
  EXPECT_TRUE(find(all, "steadiness")->log_x && find(all, "steadiness")->log_y);
}

TEST_F(Report, IsOneFileWithEverythingInIt) {
  ASSERT_TRUE(io::have_gnuplot()) << "scripts/install-deps.sh installs it";
  fs::copy(root / "steady", root / "other", fs::copy_options::recursive);
  write_report({root / "steady", root / "other"}, root / "report.html", {"png"});
  const auto html = io::read_file(root / "report.html");
  const auto has = [&](const std::string& text) { return html.find(text) != std::string::npos; };
  EXPECT_TRUE(has("data:image/svg+xml;base64,"));
  EXPECT_FALSE(has("src=\"http") || has("href=") || has("src=\"figures"));
  EXPECT_TRUE(has("<th>flow.u_bar</th><td>2 ± 0.01</td><td>2 ± 0.01</td>"));
  EXPECT_TRUE(has("<th>flow.alpha</th><td>–</td>"));
  EXPECT_TRUE(has("&lt;angle&gt; &amp; all"));
  EXPECT_TRUE(fs::exists(root / "figures" / "velocity.svg") && fs::exists(root / "figures" / "velocity.png"));
}

TEST_F(Report, ContinuumColumnsShowFrontScalingAndParticles) {
  const auto column = [&](const std::string& name, double aspect, double runout) {
    const auto dir = root / name;
    fs::create_directories(dir);
    io::write_file(dir / "case.toml", "model = \"sph\"\n");
    io::write_json(dir / "summary.json", nlohmann::ordered_json{{"model", "sph"},
                                                                {"scenario", "column"},
                                                                {"status", "completed"},
                                                                {"aspect_ratio", aspect},
                                                                {"r0", 0.1},
                                                                {"runout", runout}});
    io::write_csv(dir / "series.csv", {{"t", "", ""}, {"front", "", ""}, {"front_raw", "", ""}, {"height", "", ""}},
                  {{0, 1}, {0.1, 0.2}, {0.1, 0.21}, {0.1, 0.08}});
    auto file = io::H5File::create(dir / "run.h5");
    for (int k = 0; k < 3; ++k) {
      const std::string group = "snapshots/00000" + std::to_string(k);
      file.write(group + "/x", std::vector<Vec3>{{0.01, 0, 0.01}, {0.1 + 0.05 * k, 0, 0.01}});
      file.write(group + "/v", std::vector<Vec3>{{0, 0, 0}, {1.0 * k, 0, 0}});
      file.attribute(group, "t", 0.1 * k);
      file.attribute(group, "spacing", 0.02);
    }
    file.close();
  };
  column("low", 0.5, 0.6);
  column("tall", 2, 2.2);
  const std::vector<RunData> runs{read_run(root / "low"), read_run(root / "tall")};
  const auto all = figures(runs);
  const auto *front = find(all, "front"), *scaling = find(all, "scaling");
  ASSERT_NE(front, nullptr);
  EXPECT_NEAR(front->curves[0].y[1], 0.1, 1e-15);  // advance, not position
  ASSERT_NE(scaling, nullptr);
  EXPECT_EQ(scaling->curves[2].y, (std::vector<double>{0.6, 2.2}));
  write_report({root / "low"}, root / "low.html");
  EXPECT_TRUE(fs::exists(root / "figures" / "particles.png"));
  EXPECT_NE(io::read_file(root / "low.html").find("data:image/png;base64,"), std::string::npos);
}

TEST_F(Report, ContinuumPlaneShowsTheAnalyticProfiles) {
  io::write_json(root / "steady" / "summary.json",
                 nlohmann::ordered_json{{"model", "sph"}, {"scenario", "inclined_plane"}, {"status", "completed"}});
  io::write_csv(root / "steady" / "profile.csv",
                {{"z", "m", ""}, {"u_x", "", ""}, {"u_x_exact", "", ""}, {"p", "", ""}, {"p_exact", "", ""}},
                {{0, 1}, {0, 2}, {0, 3}, {4, 0}, {5, 0}}, io::CsvHeader::names_and_units);
  io::write_csv(root / "steady" / "series.csv", {{"t", "", ""}, {"u_mean", "", ""}}, {{0, 1}, {0, 2}});
  const std::vector<RunData> runs{read_run(root / "steady")};
  const auto all = figures(runs);
  for (const auto& [name, exact] : {std::pair{"velocity", 3.0}, std::pair{"pressure", 0.0}}) {
    const auto* figure = find(all, name);
    ASSERT_NE(figure, nullptr) << name;
    ASSERT_EQ(figure->curves.size(), 2u);
    EXPECT_EQ(figure->curves[1].x[1], exact);
    EXPECT_EQ(figure->curves[1].stroke, Stroke::dashed);
  }
}

TEST_F(Report, ADirectoryWithoutARunIsAnInputError) {
  EXPECT_THROW(write_report({root / "nothing"}, root / "report.html"), InputError);
}

}  // namespace
}  // namespace bagnold::report

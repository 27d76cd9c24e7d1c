// How layer runs end as users meet it: at time.end exactly, with the time in every file, and well when all has left.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/csv.hpp"
#include "io/json.hpp"
#include "io/raster.hpp"
#include "support/program.hpp"

namespace bagnold::test {
namespace {

std::string heap_case(const std::string& more) {
  return "model = \"shallow\"\n[scenario]\nkind = \"incline\"\nangle_deg = 26.0\nlength = 40.0\nwidth = 30.0\ncells = "
         "40\n"
         "x0 = -20.0\ny0 = -15.0\n[closure]\nset = \"custom\"\n[closure.friction]\nlaw = \"coulomb\"\ndelta_deg = "
         "14.0\n"
         "[scheme]\ntip_depth = 0.0\n" +
         more + "[release]\nshape = \"cap\"\nthickness = 2.0\nradius = 6.0\n";
}

nlohmann::json run(const Scratch& scratch, const std::string& text, const std::string& options) {
  write_text(scratch / "c.toml", text);
  const Outcome o = bagnold(scratch, "run c.toml -o out --quiet --overwrite " + options);
  EXPECT_EQ(o.exit_code, 0) << o.err;
  return io::read_json(scratch / "out" / "summary.json");
}

}  // namespace

TEST(End, OfLayersIsExactAndStandsInEveryFile) {
  const Scratch scratch;
  for (const double end : {0.01, 1.0, 4.98}) {
    const auto s = run(scratch, heap_case("[time]\nend = " + std::to_string(end) + "\n"), "");
    EXPECT_EQ(s["time"], end);
    EXPECT_EQ(s["status"], "completed");
    EXPECT_TRUE(s["all_left_at"].is_null());
    EXPECT_EQ(io::read_csv(scratch / "out" / "series.csv")["t"].back(), end);
    const auto final = io::read_csv(scratch / "out" / "final.csv", io::CsvHeader::names_and_units);
    EXPECT_EQ(final.units.size(), final.names.size());
    for (const double t : final["t"]) EXPECT_EQ(t, end);
  }
  // Asking for rows changes no bit of the end; nor does an interruption.
  const std::string often =
                        "--set output.series_every=0.01 --set output.snapshot_every=0.37 --set output.vtk_every=0.77 ",
                    slowly = "--set scheme.max_step=0.002 ";
  const std::string text = heap_case("[time]\nend = 4.98\n");
  run(scratch, text, slowly);
  const std::string plain = read_text(scratch / "out" / "final.csv");
  run(scratch, text, slowly + often);
  EXPECT_TRUE(plain == read_text(scratch / "out" / "final.csv"));
  const Outcome cut = bagnold_cut(scratch, "run c.toml -o cut --quiet " + slowly + often, "cut", 30);
  ASSERT_EQ(cut.exit_code, 75) << cut.err;
  ASSERT_EQ(bagnold(scratch, "resume cut --quiet").exit_code, 0);
  EXPECT_TRUE(plain == read_text(scratch / "cut" / "final.csv"));
  EXPECT_TRUE(read_text(scratch / "out" / "series.csv") == read_text(scratch / "cut" / "series.csv"));
}

TEST(End, OfALayerThatHasLeftIsACompletedRunWithItsMaps) {
  const Scratch scratch;
  const std::string end = "[time]\nend = 400.0\n";
  const std::string plane = "--set scenario.cells_across=30";
  for (const auto& [more, options, maps] :
       {std::tuple{end, std::string(), "final.csv"},
        {end + "[channel]\nx = [-20.0, 20.0]\nwidth = [2.0, 1.0]\n", std::string(), "final.csv"},
        {end, plane, "maps.vti"},
        {end, plane + " --set scenario.direction_deg=90.0", "maps.vti"},
        {end, plane + " --set scenario.direction_deg=225.0", "maps.vti"}}) {
    const auto s = run(scratch, heap_case(more), options);
    EXPECT_EQ(s["status"], "completed") << options;
    ASSERT_TRUE(s["all_left_at"].is_number()) << options;
    EXPECT_EQ(s["time"], s["all_left_at"]);
    EXPECT_LT(s["time"], 100);
    EXPECT_GT(s["dt_min"], 1e-3);
    EXPECT_TRUE(s["front"].is_null());
    EXPECT_LT(s["mass"].get<double>(), 1e-3 * s["mass_out"].get<double>());
    EXPECT_GT(s["max_h"], 1.8);
    EXPECT_TRUE(fs::exists(scratch / "out" / maps)) << options;
    EXPECT_EQ(io::read_csv(scratch / "out" / "series.csv")["t"].back(), s["time"].get<double>());
    // With the clock to go on to its end, the run does, and still knows.
    const auto whole = run(scratch, heap_case(more), options + " --set time.stop_when_arrested=false");
    EXPECT_EQ(whole["time"], 400);
    EXPECT_EQ(whole["all_left_at"], s["all_left_at"]);
    EXPECT_EQ(whole["status"], "completed");
  }
}

// Material leaves over all four rims of a summit.
TEST(End, OfALayerThatLeftTheTerrainHasItsRasters) {
  const Scratch scratch;
  constexpr int n = 24;
  io::Raster bed{.nx = n, .ny = n, .x0 = 0, .y0 = 0, .dx = 5, .dy = 5, .values = {}, .projection = "", .time = {}};
  io::Raster release = bed;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double x = (i + 0.5 - 0.5 * n) * 5, y = (j + 0.5 - 0.5 * n) * 5;
      bed.values.push_back(200 - 0.004 * (x * x + y * y));
      release.values.push_back(std::hypot(x, y) > 15 && std::hypot(x, y) < 30 ? 1.5 : 0);
    }
  for (double& v : bed.values) v *= 3;
  io::write_raster(scratch / "bed.tif", bed);
  io::write_raster(scratch / "release.tif", release);
  const auto s =
      run(scratch,
          "model = \"shallow\"\n[scenario]\nkind = \"terrain\"\nelevation = \"bed.tif\"\n[closure]\nset = \"custom\"\n"
          "[closure.friction]\nlaw = \"coulomb\"\ndelta_deg = 8.0\n[scheme]\ntip_depth = 0.0\n[release]\n"
          "shape = \"raster\"\nraster = \"release.tif\"\n[time]\nend = 1000.0\n",
          "");
  EXPECT_EQ(s["status"], "completed");
  ASSERT_TRUE(s["all_left_at"].is_number());
  for (const char* name : {"max_thickness", "arrival_time", "deposit"}) {
    const io::Raster map = io::read_raster(scratch / "out" / (std::string(name) + ".tif"));
    ASSERT_TRUE(map.time.has_value()) << name;
    EXPECT_EQ(*map.time, s["time"].get<double>());
  }
  EXPECT_NE(read_text(scratch / "out" / "maps.vti").find("TimeValue"), std::string::npos);
}

// What is thin is a part of the largest thickness, whether released or flowing in, whatever the grain.
TEST(DryDepth, IsAPartOfTheLargestThickness) {
  const Scratch scratch;
  const auto value = [&](const std::string& text, const std::string& key, const std::string& options = "") {
    write_text(scratch / "c.toml", text);
    const Outcome o = bagnold(scratch, "check c.toml --resolved " + options);
    EXPECT_EQ(o.exit_code, 0) << o.err;
    const auto at = o.out.find("\n" + key + " = ");
    EXPECT_NE(at, std::string::npos) << o.out;
    return std::stod(o.out.substr(at + key.size() + 4));
  };
  const std::string end = "[time]\nend = 4.0\n", fed = end +
                                                       "[boundary]\nleft = \"inflow\"\n[boundary.left_inflow]\n"
                                                       "t = [0.0, 9.0]\nh = [1.0, 7.0]\nu = [1.0, 1.0]\n";
  for (const std::string grain : {"", " --set closure.diameter=0.001"}) {
    EXPECT_DOUBLE_EQ(value(heap_case(end), "dry_depth", grain), 2e-6);
    EXPECT_DOUBLE_EQ(value(heap_case(end), "arrival_depth", grain), 2e-3);
    EXPECT_DOUBLE_EQ(value(heap_case(fed), "dry_depth", grain), 7e-6);
  }
  EXPECT_DOUBLE_EQ(value(heap_case(end), "dry_depth", "--set scheme.dry_depth=0.01"), 0.01);
  EXPECT_DOUBLE_EQ(value(heap_case(end), "arrival_depth", "--set scheme.dry_depth=0.01"), 0.1);
  const Outcome check = bagnold(scratch, "check c.toml");
  EXPECT_NE(check.out.find("dry depth"), std::string::npos) << check.out;
  for (const auto& [options, key] : {std::pair{"--set scheme.dry_depth=2.5", "dry_depth"},
                                     {"--set release.thickness=0.0", "release"},
                                     {"--set release.centre_x=200.0", "release"},
                                     {"--set scheme.dry_depth=-1.0", "dry_depth"}}) {
    const Outcome o = bagnold(scratch, std::string("check c.toml ") + options);
    EXPECT_EQ(o.exit_code, 2) << options;
    EXPECT_NE(o.err.find(key), std::string::npos) << o.err;
  }
}

// Mangeney's dam break, 30 degrees, 20 degrees of friction: the place where h = 1e-3 h0 converges to the exact one, 50.80 at t = 8.
TEST(DryDepth, DefaultLetsTheFrontOfADamBreakConverge) {
  const Scratch scratch;
  double before = INFINITY;
  for (const int cells : {200, 400, 800, 1600, 3200}) {
    const Outcome o = bagnold(scratch, "run '" + case_file("dam-break-incline.toml") +
                                           "' -o out --quiet --overwrite --set output.snapshot_every=100 --set "
                                           "output.vtk_every=100 --set output.series_every=8 --set scenario.cells=" +
                                           std::to_string(cells));
    ASSERT_EQ(o.exit_code, 0) << o.err;
    const double degree = std::acos(-1) / 180, g = std::cos(30 * degree), t = 8, h = 0.01,
                 m = g * (std::tan(30 * degree) - std::tan(20 * degree)),
                 exact = (2 * std::sqrt(10 * g) + m * t / 2) * t - t * std::sqrt(9 * g * h);
    const double error = exact - io::read_json(scratch / "out" / "summary.json")["front"].get<double>();
    EXPECT_LT(std::abs(error), 0.68 * before) << cells;
    before = std::abs(error);
  }
  EXPECT_LT(before, 0.5);
}

}  // namespace bagnold::test

// The shallow-layer model as users meet it: closures from files, terrain and releases in every format, maps in the
// coordinate system that came in, and errors that say what is wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/csv.hpp"
#include "io/json.hpp"
#include "io/raster.hpp"
#include "support/program.hpp"

namespace bagnold::test {
namespace {

constexpr int nx = 40, ny = 24;
constexpr double x0 = 500000, y0 = 5100000, cell = 5;

// A valley that falls to the east by 0.5 and rises to both sides.
double elevation(double x, double y) {
  return 1000 - 0.5 * (x - x0) + 0.002 * (y - y0 - 0.5 * ny * cell) * (y - y0 - 0.5 * ny * cell);
}

std::string utm32() { return read_text(case_file("valley/elevation.prj")); }

io::Raster terrain(const std::string& projection) {
  io::Raster r{.nx = nx, .ny = ny, .x0 = x0, .y0 = y0, .dx = cell, .dy = cell, .values = {}, .projection = projection};
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) r.values.push_back(elevation(x0 + (i + 0.5) * cell, y0 + (j + 0.5) * cell));
  return r;
}

// The square [from, to] in x and y from the corner of the terrain.
std::string geojson(double from, double to, const std::string& crs = "urn:ogc:def:crs:EPSG::32632",
                    const std::string& properties = "\"thickness\": 3.0") {
  const auto point = [](double x, double y) {
    return "[" + std::to_string(x0 + x) + ", " + std::to_string(y0 + y) + "]";
  };
  return "{\"type\": \"FeatureCollection\", \"crs\": {\"type\": \"name\", \"properties\": {\"name\": \"" + crs +
         "\"}}, \"features\": [{\"type\": \"Feature\", \"properties\": {" + properties +
         "}, \"geometry\": {\"type\": \"Polygon\", \"coordinates\": [[" + point(from, from) + "," + point(to, from) +
         "," + point(to, to) + "," + point(from, to) + "," + point(from, from) + "]]}}]}";
}

// A shapefile of one square with the attribute "thickness", byte by byte (ESRI white paper, July 1998).
void write_shapefile(const fs::path& stem, double from, double to, double thickness) {
  std::string shp, shx, dbf;
  const auto big = [](std::string& s, std::int32_t v) {
    for (int k = 3; k >= 0; --k) s.push_back(static_cast<char>(v >> (8 * k) & 0xff));
  };
  const auto little = [](std::string& s, auto v) {
    char bytes[sizeof v];
    std::memcpy(bytes, &v, sizeof v);
    s.append(bytes, sizeof v);
  };
  constexpr std::int32_t polygon = 5, points = 5, content = (4 + 32 + 8 + 4 + points * 16) / 2;  // 16-bit words
  const auto header = [&](std::string& s, std::int32_t words) {
    big(s, 9994);
    for (int k = 0; k < 5; ++k) big(s, 0);
    big(s, words);
    little(s, std::int32_t{1000});
    little(s, polygon);
    for (const double v : {x0 + from, y0 + from, x0 + to, y0 + to, 0.0, 0.0, 0.0, 0.0}) little(s, v);
  };
  header(shp, 50 + 4 + content);
  big(shp, 1);
  big(shp, content);
  little(shp, polygon);
  for (const double v : {x0 + from, y0 + from, x0 + to, y0 + to}) little(shp, v);
  little(shp, std::int32_t{1});
  little(shp, points);
  little(shp, std::int32_t{0});
  for (const auto& [x, y] : {std::pair{from, from}, {from, to}, {to, to}, {to, from}, {from, from}}) {  // clockwise
    little(shp, x0 + x);
    little(shp, y0 + y);
  }
  header(shx, 50 + 4);
  big(shx, 50);
  big(shx, content);
  dbf += std::string("\x03\x7c\x01\x01", 4);
  little(dbf, std::int32_t{1});
  little(dbf, std::int16_t{32 + 32 + 1});
  little(dbf, std::int16_t{1 + 12});
  dbf.append(20, '\0');
  dbf +=
      std::string("thickness\0\0", 11) + "N" + std::string(4, '\0') + '\x0c' + '\x03' + std::string(14, '\0') + "\r ";
  char number[13];
  std::snprintf(number, sizeof number, "%12.3f", thickness);
  dbf += number;
  dbf += '\x1a';
  for (const auto& [suffix, bytes] : {std::pair{".shp", &shp}, {".shx", &shx}, {".dbf", &dbf}})
    write_text(stem.string() + suffix, *bytes);
  write_text(stem.string() + ".prj", utm32());
}

std::string valley_case(const std::string& elevation_file, const std::string& release) {
  return "model = \"shallow\"\n[scenario]\nkind = \"terrain\"\nelevation = \"" + elevation_file +
         "\"\n[closure.friction]\nlaw = \"voellmy\"\nmu0 = 0.2\nxi = 500.0\n[closure.density]\nlaw = \"constant\"\nphi "
         "= 0.5\n"
         "[scheme]\ndry_depth = 0.001\ntip_depth = 0.0\n[time]\nend = 3.0\n[observe]\ngauges = [{x = 500060.0, y = "
         "5100060.0}]\n"
         "sections = [{from = [500080.0, 5100020.0], to = [500080.0, 5100100.0]}]\narrival_depth = 0.01\n[release]\n" +
         release;
}

const std::string square = "shape = \"polygons\"\npolygons = \"release.geojson\"\n";

// Elevation and release in `scratch`; then `change` may spoil something.
void make_valley(const Scratch& scratch) {
  io::write_raster(scratch / "dem.tif", terrain(utm32()));
  io::write_raster(scratch / "dem.asc", terrain(utm32()));
  write_text(scratch / "release.geojson", geojson(40, 70));
  write_shapefile(scratch / "release", 40, 70, 3);
  io::Raster r = terrain(utm32());
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      r.values[static_cast<std::size_t>(j * nx + i)] = i >= 8 && i < 14 && j >= 8 && j < 14 ? 3 : 0;
  io::write_raster(scratch / "release.tif", r);
}

// Runs and expects exit code 2 and every part of the message.
void expect_refusal(const Scratch& scratch, const std::string& text, const std::vector<std::string>& parts) {
  write_text(scratch / "c.toml", text);
  const Outcome o = bagnold(scratch, "run c.toml -o out --quiet --overwrite");
  EXPECT_EQ(o.exit_code, 2) << o.err;
  for (const std::string& part : parts) EXPECT_NE(o.err.find(part), std::string::npos) << part << " not in: " << o.err;
}

}  // namespace

TEST(Valley, EveryFormatOfTerrainAndReleaseGivesTheSameRun) {
  const Scratch scratch;
  make_valley(scratch);
  std::string first;
  for (const char* dem : {"dem.tif", "dem.asc"})
    for (const char* release :
         {"shape = \"polygons\"\npolygons = \"release.geojson\"\n",
          "shape = \"polygons\"\npolygons = \"release.shp\"\n", "shape = \"raster\"\nraster = \"release.tif\"\n"}) {
      write_text(scratch / "c.toml", valley_case(dem, release));
      const Outcome o = bagnold(scratch, "run c.toml -o out --quiet --overwrite");
      ASSERT_EQ(o.exit_code, 0) << dem << release << o.err;
      const std::string series = read_text(scratch / "out" / "series.csv");
      if (first.empty()) first = series;
      if (std::string(dem) == "dem.tif") {  // .asc has six decimals
        EXPECT_TRUE(series == first) << release;
      }
      const auto summary = io::read_json(scratch / "out" / "summary.json");
      EXPECT_LT(std::abs(summary["mass_error_rel"].get<double>()), 1e-12);
      EXPECT_GT(summary["max_speed"].get<double>(), 5);
    }
}

TEST(Valley, MapsLieWhereTheTerrainLies) {
  const Scratch scratch;
  make_valley(scratch);
  write_text(scratch / "c.toml", valley_case("dem.tif", square));
  ASSERT_EQ(bagnold(scratch, "run c.toml -o out --quiet --set output.vtk_every=1.5").exit_code, 0);
  const io::Raster in = io::read_raster(scratch / "dem.tif");
  for (const char* name :
       {"max_thickness", "max_speed", "max_pressure", "arrival_time", "deposit", "outside_validity"}) {
    const io::Raster map = io::read_raster(scratch / "out" / (std::string(name) + ".tif"));
    EXPECT_EQ(map.nx, nx);
    EXPECT_EQ(map.ny, ny);
    EXPECT_EQ(map.x0, x0);
    EXPECT_EQ(map.y0, y0);
    EXPECT_EQ(map.dx, cell);
    EXPECT_TRUE(io::same_projection(map.projection, in.projection)) << name;
    EXPECT_FALSE(map.projection.empty());
  }
  const io::Raster depth = io::read_raster(scratch / "out" / "max_thickness.tif"),
                   arrival = io::read_raster(scratch / "out" / "arrival_time.tif"),
                   speed = io::read_raster(scratch / "out" / "max_speed.tif"),
                   pressure = io::read_raster(scratch / "out" / "max_pressure.tif");
  const auto at = [](const io::Raster& r, int i, int j) { return r.values[static_cast<std::size_t>(j * nx + i)]; };
  EXPECT_NEAR(at(depth, 10, 10), 3, 0.3);
  EXPECT_EQ(at(arrival, 10, 8), 0);   // where it was released; rows are not upside down:
  EXPECT_NE(at(arrival, 10, 15), 0);  // its mirror image was free
  EXPECT_TRUE(std::isnan(at(arrival, 2, 20)));
  EXPECT_GT(at(arrival, 16, 11), 0);                                                           // downhill, later
  EXPECT_LE(at(pressure, 16, 11), 0.5 * at(speed, 16, 11) * at(speed, 16, 11) * (1 + 1e-12));  // rho u^2, rho = phi
  for (const char* name : {"maps.vti", "vtk/layer.pvd", "run.h5"})
    EXPECT_TRUE(fs::exists(scratch / "out" / name)) << name;
  const auto series = io::read_csv(scratch / "out" / "series.csv");
  EXPECT_GT(series["gauge0_h"].front(), 2.9);
  EXPECT_EQ(series["section0_discharge"].front(), 0);
  EXPECT_GT(series["section0_discharge"].back(), 1);
}

// The case kept with a run names its inputs relative to the run: it runs again, resumes, and moves together with them.
TEST(Valley, TheResolvedCaseRunsAgainAndMovesWithItsInputs) {
  const Scratch scratch;
  fs::create_directories(scratch / "here" / "data");
  make_valley(scratch);
  for (const char* name : {"dem.tif", "release.geojson"}) fs::rename(scratch / name, scratch / "here" / "data" / name);
  write_text(scratch / "here" / "c.toml",
             valley_case("data/dem.tif", "shape = \"polygons\"\npolygons = \"data/release.geojson\"\n"));
  ASSERT_EQ(bagnold(scratch, "run here/c.toml -o here/runs/a --quiet").exit_code, 0);
  const std::string kept = read_text(scratch / "here" / "runs" / "a" / "case.toml");
  EXPECT_NE(kept.find("elevation = \"../../data/dem.tif\""), std::string::npos) << kept;
  EXPECT_NE(kept.find("polygons = \"../../data/release.geojson\""), std::string::npos) << kept;
  EXPECT_EQ(kept.find(scratch.path().string()), std::string::npos) << kept;
  EXPECT_EQ(read_text(scratch / "here" / "runs" / "a" / "run.h5").find(scratch.path().string()), std::string::npos);

  fs::rename(scratch / "here", scratch / "elsewhere");
  const Outcome resumed = bagnold(scratch, "resume elsewhere/runs/a --quiet");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  const Outcome again = bagnold(scratch, "run elsewhere/runs/a/case.toml -o b --quiet");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_TRUE(read_text(scratch / "elsewhere" / "runs" / "a" / "series.csv") ==
              read_text(scratch / "b" / "series.csv"));
  EXPECT_NE(read_text(scratch / "b" / "case.toml").find("\"../elsewhere/data/dem.tif\""), std::string::npos);
}

TEST(Valley, InterruptedAndResumedGivesTheSameBits) {
  const Scratch scratch;
  make_valley(scratch);
  write_text(scratch / "c.toml", valley_case("dem.tif", square));
  std::string longer =
      " --quiet --set time.end=1e4 --set time.stop_when_arrested=false --set output.series_every=0.05 "
      "--set output.snapshot_every=5000 --set output.vtk_every=5000";
  for (const char* side : {"left", "right", "bottom", "top"})
    longer += std::string(" --set boundary.") + side + "=wall";
  longer += " --set scheme.max_step=0.002";  // so that it is not over before it is cut
  const Outcome cut = bagnold_cut(scratch, "run c.toml -o cut" + longer, "cut", 20);
  ASSERT_EQ(cut.exit_code, 75) << cut.err;
  const auto stopped = io::read_json(scratch / "cut" / "summary.json");
  EXPECT_EQ(stopped["status"], "interrupted");
  const double t = stopped["time"].get<double>();
  ASSERT_GT(t, 0);
  // Both go a little further than where the run was cut: the case kept with it may be given another end.
  std::string kept = read_text(scratch / "cut" / "case.toml");
  const std::string end = "end = 10000.0";
  ASSERT_NE(kept.find(end), std::string::npos) << kept;
  const std::string sooner = std::to_string(std::ceil(1.2 * t) + 5);
  kept.replace(kept.find(end), end.size(), "end = " + sooner);
  write_text(scratch / "cut" / "case.toml", kept);
  ASSERT_EQ(bagnold(scratch, "resume cut --quiet").exit_code, 0);
  ASSERT_EQ(bagnold(scratch, "run c.toml -o whole" + longer + " --set time.end=" + sooner).exit_code, 0);
  EXPECT_TRUE(read_text(scratch / "whole" / "series.csv") == read_text(scratch / "cut" / "series.csv"));
  for (const char* map :
       {"max_thickness.tif", "max_speed.tif", "arrival_time.tif", "deposit.tif", "outside_validity.tif"})
    EXPECT_TRUE(read_text(scratch / "whole" / map) == read_text(scratch / "cut" / map)) << map;
}

// Thickness is normal to the ground: a vertical one is cos(slope) of it thick, and a column keeps its volume.
TEST(Valley, VerticalAndNormalReleases) {
  const Scratch scratch;
  make_valley(scratch);
  double mass[2];
  for (const int k : {0, 1}) {
    write_text(scratch / "c.toml",
               valley_case("dem.tif", square + "direction = \"" + (k == 0 ? "vertical" : "normal") + "\"\n"));
    ASSERT_EQ(bagnold(scratch, "run c.toml -o out --quiet --overwrite --set time.end=0.01").exit_code, 0);
    mass[k] = io::read_csv(scratch / "out" / "series.csv")["mass"].front();
  }
  EXPECT_NEAR(mass[0] / (0.5 * 3 * 30 * 30), 1, 1e-12);  // phi rho_p t on the map's area
  double area = 0;
  for (int j = 8; j < 14; ++j) area += 6 * cell * cell * std::hypot(1, 0.5, 0.004 * ((j + 0.5) * cell - 60));
  EXPECT_NEAR(mass[1] / (0.5 * 3 * area), 1, 1e-12);
}

TEST(ValleyErrors, MissingData) {
  const Scratch scratch;
  make_valley(scratch);
  io::Raster holed = terrain(utm32());
  holed.values[static_cast<std::size_t>(5 * nx + 7)] = std::numeric_limits<double>::quiet_NaN();
  for (const char* name : {"holed.tif", "holed.asc"}) {
    io::write_raster(scratch / name, holed);
    expect_refusal(scratch, valley_case(name, square), {"c.toml:4", "no data at column 7, row 5"});
  }
  write_text(scratch / "c.toml", valley_case("absent.tif", square));
  const Outcome absent = bagnold(scratch, "run c.toml -o out --quiet");
  EXPECT_EQ(absent.exit_code, 4);
  EXPECT_NE(absent.err.find("absent.tif"), std::string::npos) << absent.err;
  expect_refusal(scratch, valley_case("dem.tif", "shape = \"polygons\"\n"), {"polygons", "missing"});
}

TEST(ValleyErrors, MismatchedGrids) {
  const Scratch scratch;
  make_valley(scratch);
  const std::string release = "shape = \"raster\"\nraster = \"other.tif\"\n";
  io::Raster shifted = terrain(utm32());
  for (double& v : shifted.values) v = 1;
  io::Raster smaller = shifted, flat = shifted, stretched = shifted;
  shifted.x0 += cell;
  smaller.nx -= 1;
  smaller.values.resize(static_cast<std::size_t>(smaller.nx * smaller.ny));
  stretched.dy *= 1.5;
  flat.dx *= 2;
  flat.dy *= 2;
  for (const io::Raster& r : {shifted, smaller, stretched, flat}) {
    io::write_raster(scratch / "other.tif", r);
    expect_refusal(scratch, valley_case("dem.asc", release), {"its grid", "is not that of the terrain"});
  }
}

TEST(ValleyErrors, WrongProjection) {
  const Scratch scratch;
  make_valley(scratch);
  write_text(scratch / "release.geojson", geojson(40, 70, "urn:ogc:def:crs:EPSG::32633"));
  expect_refusal(scratch, valley_case("dem.tif", square), {"projection is not that of the terrain"});
  write_text(scratch / "release.geojson", geojson(40, 70, "urn:ogc:def:crs:OGC:1.3:CRS84"));
  expect_refusal(scratch, valley_case("dem.asc", square), {"projection is not that of the terrain"});
  const std::string degrees =
      "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],"
      "UNIT[\"degree\",0.0174532925199433]]";
  io::write_raster(scratch / "degrees.tif", terrain(degrees));
  expect_refusal(scratch, valley_case("degrees.tif", square), {"degrees", "projected"});
}

TEST(ValleyErrors, ReleaseOutsideTheTerrain) {
  const Scratch scratch;
  make_valley(scratch);
  write_text(scratch / "release.geojson", geojson(150, 260));
  expect_refusal(scratch, valley_case("dem.tif", square), {"lies outside the terrain", "5100150"});
  write_shapefile(scratch / "release", -30, 20, 3);
  expect_refusal(scratch, valley_case("dem.asc", "shape = \"polygons\"\npolygons = \"release.shp\"\n"),
                 {"lies outside the terrain", "499970"});
  write_text(scratch / "release.geojson", geojson(41, 42));  // between the centres of the cells
  expect_refusal(scratch, valley_case("dem.tif", square), {"covers no cell"});
  write_text(scratch / "release.geojson", geojson(40, 70, "urn:ogc:def:crs:EPSG::32632", "\"name\": \"slab\""));
  expect_refusal(scratch, valley_case("dem.tif", square), {"thickness"});
}

TEST(ValleyErrors, GaugesAndSectionsOutside) {
  const Scratch scratch;
  make_valley(scratch);
  std::string text = valley_case("dem.tif", square);
  text.replace(text.find("500060"), 6, "400060");
  expect_refusal(scratch, text, {"gauge", "outside the grid"});
  text = valley_case("dem.tif", square);
  text.replace(text.find("500080"), 6, "400080");
  expect_refusal(scratch, text, {"cross-section leaves the grid"});
}

namespace {

const std::string closure_file =
    "[stopping_height]\nlaw = \"pouliquen-forterre\"\ndelta1_deg = 17.708\ndelta2_deg = 32.780\nA = 3.355\n"
    "covariance = [[0.1, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.0, 0.3]]\n"
    "[flow_rule.1]\nbeta = 0.196\ngamma = 0.040\nerr = 0.121\n[flow_rule.2]\nbeta = 0.189\ngamma = 0.080\n"
    "[density]\nc0 = 0.5985\nc1_deg = 4.8\nc2_deg = 40.85\n[stress_ratio]\nd0_deg = 132.0\nd1_deg = 21.50\n"
    "[shape_factor]\nbase_layer = 6.678\n[validity]\ntheta_deg = [17.708, 29.0]\n[provenance]\nruns = [\"a\", \"b\"]\n";

std::string layer_case(const std::string& closure) {
  return "model = \"shallow\"\n[scenario]\nkind = \"incline\"\nangle_deg = 25.0\nlength = 300.0\ncells = 150\n"
         "[closure]\n" +
         closure +
         "[release]\nshape = \"cap\"\nthickness = 15.0\ncentre_x = 100.0\nradius = 60.0\n[time]\nend = 20.0\n";
}

}  // namespace

TEST(ClosureFile, OfTheNumbersOfThePaperGivesTheBitsOfTheBuiltInSet) {
  const Scratch scratch;
  write_text(scratch / "closure.toml", closure_file);
  write_text(scratch / "file.toml", layer_case("set = \"closure.toml\"\ngrain_density = 1.9\n"));
  write_text(scratch / "set.toml", layer_case("set = \"weinhart2012/1\"\ngrain_density = 1.9\n"));
  write_text(scratch / "other.toml", layer_case("set = \"closure.toml\"\nlambda = \"2\"\ngrain_density = 1.9\n"));
  for (const char* name : {"file", "set", "other"}) {
    const Outcome o = bagnold(scratch, std::string("run ") + name + ".toml -o " + name + " --quiet");
    ASSERT_EQ(o.exit_code, 0) << o.err;
  }
  EXPECT_TRUE(read_text(scratch / "file" / "final.csv") == read_text(scratch / "set" / "final.csv"));
  EXPECT_FALSE(read_text(scratch / "other" / "final.csv") == read_text(scratch / "set" / "final.csv"));
}

// The mask is the range of tan(theta) = mu(h, F), eq. 37: at h = 10, lambda = 1, 20 degrees are F = 0.053 and 29 degrees
// F = 1.489, which are u = 0.161 and u = 4.53 at 22 degrees, where a layer at rest stays. What rests uses no closure.
TEST(ClosureFile, ValidityMaskIsOneWhereFrictionLeavesTheMeasuredRange) {
  const Scratch scratch;
  std::string text = closure_file;
  text.replace(text.find("[17.708, 29.0]"), 14, "[20.0, 29.0]");
  write_text(scratch / "closure.toml", text);
  for (const auto& [speed, outside] : {std::pair{0.0, 0.0}, {0.12, 1.0}, {0.20, 0.0}, {4.4, 0.0}, {4.6, 1.0}}) {
    write_text(
        scratch / "c.toml",
        "model = \"shallow\"\n[scenario]\nkind = \"incline\"\nangle_deg = 22.0\nlength = 20.0\ncells = 10\n[closure]\n"
        "set = \"closure.toml\"\n[boundary]\nleft = \"periodic\"\nright = \"periodic\"\n[release]\nshape = \"slab\"\n"
        "thickness = 10.0\nvelocity = " +
            std::to_string(speed) + "\n[time]\nend = 1e-3\n");
    const Outcome o = bagnold(scratch, "run c.toml -o out --quiet --overwrite --set scheme.max_step=1e-3");
    ASSERT_EQ(o.exit_code, 0) << o.err;
    const auto final = io::read_csv(scratch / "out" / "final.csv", io::CsvHeader::names_and_units);
    EXPECT_EQ(final.rows(), 10u);
    for (const double cell : final["outside"]) EXPECT_EQ(cell, outside) << speed;
    EXPECT_EQ(io::read_json(scratch / "out" / "summary.json")["outside_validity_fraction"].get<double>(), outside);
  }
}

TEST(ClosureFile, ErrorsNameTheFileAndTheKey) {
  const Scratch scratch;
  const auto refuse = [&](const std::string& from, const std::string& to, const std::vector<std::string>& parts) {
    std::string text = closure_file;
    text.replace(text.find(from), from.size(), to);
    write_text(scratch / "closure.toml", text);
    expect_refusal(scratch, layer_case("set = \"closure.toml\"\n"), parts);
  };
  refuse("beta = 0.196\n", "", {"closure.toml", "beta", "missing"});
  refuse("delta2_deg = 32.780", "delta2_deg = 12.0", {"closure.toml:4", "delta2_deg"});
  refuse("c0 = 0.5985", "c0 = 5985", {"closure.toml", "c0"});
  refuse("theta_deg = [17.708, 29.0]", "theta_deg = [29.0, 17.7]", {"closure.toml", "theta_deg"});
  refuse("[flow_rule.1]", "[flow_rule.3]", {"no flow rule for lambda = 1", "2"});
  refuse("gamma = 0.040", "gama = 0.040", {"closure.toml", "gam"});
  refuse("law = \"pouliquen-forterre\"", "law = \"linear\"", {"closure.toml", "law", "pouliquen-forterre"});
  refuse("[density]", "[densty]", {"closure.toml", "densty"});
  expect_refusal(scratch, layer_case("set = \"weinhart2012/7\"\n"), {"weinhart2012/7", "weinhart2012/1"});
  write_text(scratch / "c.toml", layer_case("set = \"absent.toml\"\n"));
  EXPECT_EQ(bagnold(scratch, "run c.toml -o out --quiet").exit_code, 2);
}

TEST(ClosureSection, UnphysicalNumbersAreRefused) {
  const Scratch scratch;
  for (const char* law :
       {"[closure.friction]\nlaw = \"coulomb\"\ndelta_deg = 95.0\n",
        "[closure.friction]\nlaw = \"voellmy\"\nxi = -1.0\n", "[closure.friction]\nlaw = \"mu-of-i\"\nphi = 1.5\n",
        "[closure.friction]\nlaw = \"jenkins\"\nA = 0.0\n", "[closure.friction]\nlaw = \"exponential\"\nbeta = -0.1\n",
        "[closure.shape_factor]\nlaw = \"constant\"\nalpha = 0.9\n",
        "[closure.stress_ratio]\nlaw = \"constant\"\nK = 0.0\n", "[closure.density]\nlaw = \"constant\"\nphi = 0.0\n",
        "[closure.static_branch]\nkappa = 0.0\n"})
    expect_refusal(scratch, layer_case(std::string("set = \"custom\"\n") + law), {"c.toml", "expected"});
}

TEST(Explain, ShowsTheSetsAndLawsOfTheLayer) {
  const Scratch scratch;
  for (const char* name :
       {"weinhart2012/1", "weinhart2012/2/3", "voellmy", "mu-of-i", "static-branch", "strain-model"}) {
    const Outcome o = bagnold(scratch, std::string("explain ") + name);
    EXPECT_EQ(o.exit_code, 0) << name << o.err;
    EXPECT_NE(o.out.find(name), std::string::npos) << o.out;
  }
}

}  // namespace bagnold::test

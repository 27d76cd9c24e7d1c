// Rasters and polygons: what is written comes back, with its place on the map.
#include "io/raster.hpp"

#include <cmath>
#include <fstream>
#include <limits>

#include "core/error.hpp"
#include "scratch.hpp"

namespace bagnold::io {
namespace {

const std::string utm32 =
    "PROJCS[\"WGS 84 / UTM zone 32N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],"
    "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],"
    "PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",9],PARAMETER[\"scale_factor\",0.9996],"
    "PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\",0],UNIT[\"metre\",1]]";

Raster sample() {
  Raster r{.nx = 5, .ny = 3, .x0 = 500000.5, .y0 = 5100000.25, .dx = 2.5, .dy = 2.5, .values = {}, .projection = utm32};
  for (int k = 0; k < 15; ++k) r.values.push_back(100 + 0.5 * k);
  r.values[7] = std::numeric_limits<double>::quiet_NaN();
  return r;
}

void expect_same(const Raster& a, const Raster& b, double tolerance) {
  EXPECT_EQ(a.nx, b.nx);
  EXPECT_EQ(a.ny, b.ny);
  EXPECT_NEAR(a.x0, b.x0, tolerance);
  EXPECT_NEAR(a.y0, b.y0, tolerance);
  EXPECT_NEAR(a.dx, b.dx, tolerance);
  EXPECT_NEAR(a.dy, b.dy, tolerance);
  ASSERT_EQ(a.values.size(), b.values.size());
  for (std::size_t k = 0; k < a.values.size(); ++k) {
    EXPECT_EQ(std::isnan(a.values[k]), std::isnan(b.values[k])) << k;
    if (!std::isnan(a.values[k])) {
      EXPECT_NEAR(a.values[k], b.values[k], tolerance) << k;
    }
  }
}

void write(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

}  // namespace

TEST(Raster, GeoTiffComesBackExactly) {
  const Scratch scratch;
  write_raster(scratch / "a.tif", sample());
  const Raster r = read_raster(scratch / "a.tif");
  expect_same(r, sample(), 0);
  EXPECT_TRUE(same_projection(r.projection, utm32));
  EXPECT_FALSE(r.time.has_value());
  Raster later = sample();
  later.time = 4.98;
  write_raster(scratch / "later.tif", later);
  EXPECT_EQ(read_raster(scratch / "later.tif").time, 4.98);
}

TEST(Raster, EsriAsciiComesBackWithItsProjectionBesideIt) {
  const Scratch scratch;
  write_raster(scratch / "a.asc", sample());
  EXPECT_TRUE(std::filesystem::exists(scratch / "a.prj"));
  const Raster r = read_raster(scratch / "a.asc");
  expect_same(r, sample(), 1e-6);
  EXPECT_TRUE(same_projection(r.projection, utm32));
}

// Rows go from north to south in the file, from south to north here; cell corners and centres are told apart.
TEST(Raster, EsriAsciiByHand) {
  const Scratch scratch;
  write(scratch / "a.asc", "ncols 2\nnrows 2\nxllcorner 10\nyllcorner 20\ncellsize 4\nNODATA_value -1\n1 2\n3 -1\n");
  const Raster r = read_raster(scratch / "a.asc");
  EXPECT_EQ(r.x0, 10);
  EXPECT_EQ(r.y0, 20);
  EXPECT_EQ(r.dx, 4);
  EXPECT_EQ(r.values[0], 3);  // south-west
  EXPECT_TRUE(std::isnan(r.values[1]));
  EXPECT_EQ(r.values[2], 1);
  EXPECT_TRUE(r.projection.empty());
  write(scratch / "b.asc", "ncols 2\nnrows 2\nxllcenter 10\nyllcenter 20\ncellsize 4\n1 2\n3 4\n");
  EXPECT_EQ(read_raster(scratch / "b.asc").x0, 8);
  EXPECT_EQ(read_raster(scratch / "b.asc").y0, 18);
}

TEST(Raster, ErrorsNameTheFile) {
  const Scratch scratch;
  EXPECT_TRUE(contains(error_of<IoError>([&] { (void)read_raster(scratch / "absent.tif"); }), "absent.tif"));
  write(scratch / "bad.tif", "not a raster");
  EXPECT_TRUE(contains(error_of<IoError>([&] { (void)read_raster(scratch / "bad.tif"); }), "bad.tif"));
  EXPECT_TRUE(contains(error_of<IoError>([&] { write_raster(scratch / "no" / "where.tif", sample()); }), "where.tif"));
}

TEST(Projection, SameOrNot) {
  const std::string utm33 = [] {
    std::string s = utm32;
    s.replace(s.find("zone 32N"), 8, "zone 33N");
    s.replace(s.find("\"central_meridian\",9"), 20, "\"central_meridian\",15");
    return s;
  }();
  EXPECT_TRUE(same_projection(utm32, utm32));
  EXPECT_FALSE(same_projection(utm32, utm33));
  EXPECT_TRUE(same_projection("", utm32));  // a file without one is believed to fit
  EXPECT_FALSE(in_degrees(utm32));
  EXPECT_FALSE(in_degrees(""));
  EXPECT_TRUE(in_degrees(utm32.substr(utm32.find("GEOGCS"), utm32.find(",PROJECTION") - utm32.find("GEOGCS"))));
}

TEST(Polygons, GeoJsonWithAHole) {
  const Scratch scratch;
  write(scratch / "a.geojson",
        R"({"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32632"}},
 "features": [
 {"type": "Feature", "properties": {"thickness": 2.5}, "geometry": {"type": "Polygon", "coordinates":
   [[[0, 0], [10, 0], [10, 10], [0, 10], [0, 0]], [[4, 4], [6, 4], [6, 6], [4, 6], [4, 4]]]}},
 {"type": "Feature", "properties": {"thickness": null}, "geometry": {"type": "MultiPolygon", "coordinates":
   [[[[20, 0], [21, 0], [21, 1], [20, 0]]], [[[30, 0], [31, 0], [31, 1], [30, 0]]]]}}]})");
  const PolygonLayer layer = read_polygons(scratch / "a.geojson");
  ASSERT_EQ(layer.polygons.size(), 3u);
  EXPECT_EQ(layer.polygons[0].thickness, 2.5);
  EXPECT_FALSE(layer.polygons[1].thickness);
  EXPECT_TRUE(same_projection(layer.projection, utm32));
  EXPECT_TRUE(contains(layer.polygons[0], 1, 1));
  EXPECT_FALSE(contains(layer.polygons[0], 5, 5));
  EXPECT_FALSE(contains(layer.polygons[0], 11, 5));
  EXPECT_TRUE(contains(layer.polygons[2], 30.9, 0.5));
}

TEST(Polygons, ErrorsNameTheFile) {
  const Scratch scratch;
  write(scratch / "points.geojson",
        R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {},
 "geometry": {"type": "Point", "coordinates": [1, 2]}}]})");
  EXPECT_TRUE(contains(error_of<InputError>([&] { (void)read_polygons(scratch / "points.geojson"); }), "no polygon"));
  EXPECT_TRUE(contains(error_of<IoError>([&] { (void)read_polygons(scratch / "absent.shp"); }), "absent.shp"));
}

}  // namespace bagnold::io

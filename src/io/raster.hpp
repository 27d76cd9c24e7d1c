// Georeferenced rasters and polygons, through GDAL. The only place that includes it.
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace bagnold::io {

// Cells in rows from south to north; (x0, y0) is the outer corner of the south-west cell. NaN: no data.
struct Raster {
  int nx = 0, ny = 0;
  double x0 = 0, y0 = 0, dx = 1, dy = 1;
  std::vector<double> values;  // values[j * nx + i]
  std::string projection;      // WKT; empty when the file has none
  std::optional<double> time;  // of what it shows: metadata item TIME of the file (GeoTIFF only)
};

// First band of any raster GDAL can read (GeoTIFF, ESRI ASCII grid, ...). Throws IoError when it cannot be opened,
// InputError when it is rotated or sheared.
Raster read_raster(const std::filesystem::path& path);

// .tif writes GeoTIFF (deflate), .asc an ESRI ASCII grid. NaN is written as the no-data value.
void write_raster(const std::filesystem::path& path, const Raster& raster);

// A polygon with holes: points inside an odd number of rings are inside.
struct Polygon {
  std::vector<std::vector<std::array<double, 2>>> rings;
  std::optional<double> thickness;  // attribute "thickness", if the layer has it
};
struct PolygonLayer {
  std::vector<Polygon> polygons;
  std::string projection;  // WKT
};
// First layer of a vector file (GeoJSON, Shapefile, ...). Throws IoError; InputError when it holds no polygon.
PolygonLayer read_polygons(const std::filesystem::path& path);
bool contains(const Polygon& polygon, double x, double y);

// Whether two projections (WKT) are the same; an absent one matches anything.
bool same_projection(const std::string& a, const std::string& b);
// Whether a projection (WKT) is geographic: latitude and longitude rather than lengths.
bool in_degrees(const std::string& projection);

}  // namespace bagnold::io

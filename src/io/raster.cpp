#include "io/raster.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <limits>
#include <memory>

#include "core/error.hpp"

namespace bagnold::io {
namespace {

struct Close {
  void operator()(GDALDataset* d) const { GDALClose(d); }
};
using Dataset = std::unique_ptr<GDALDataset, Close>;

Dataset open(const std::filesystem::path& path, unsigned kind) {
  GDALAllRegister();
  CPLPushErrorHandler(CPLQuietErrorHandler);
  Dataset data(static_cast<GDALDataset*>(GDALOpenEx(path.c_str(), kind | GDAL_OF_READONLY, nullptr, nullptr, nullptr)));
  CPLPopErrorHandler();
  if (!data) {
    const std::string reason = CPLGetLastErrorMsg();
    throw IoError(fmt::format("{}: {}", path.string(), reason.empty() ? "cannot be read" : reason));
  }
  return data;
}

constexpr double no_data = -9999;
constexpr const char* time_item = "TIME";

}  // namespace

Raster read_raster(const std::filesystem::path& path) {
  const Dataset data = open(path, GDAL_OF_RASTER);
  if (data->GetRasterCount() < 1) throw InputError(path.string() + ": holds no raster band");
  double t[6];
  if (data->GetGeoTransform(t) != CE_None) throw InputError(path.string() + ": has no georeference");
  if (t[2] != 0 || t[4] != 0) throw InputError(path.string() + ": is rotated; expected rows that run west to east");
  Raster r;
  r.nx = data->GetRasterXSize();
  r.ny = data->GetRasterYSize();
  r.dx = t[1];
  r.dy = std::abs(t[5]);
  r.x0 = t[0];
  const bool north_up = t[5] < 0;
  r.y0 = north_up ? t[3] - r.dy * r.ny : t[3];
  r.projection = data->GetProjectionRef();
  if (const char* time = data->GetMetadataItem(time_item)) r.time = CPLAtof(time);
  GDALRasterBand* band = data->GetRasterBand(1);
  std::vector<double> rows(static_cast<std::size_t>(r.nx) * static_cast<std::size_t>(r.ny));
  if (band->RasterIO(GF_Read, 0, 0, r.nx, r.ny, rows.data(), r.nx, r.ny, GDT_Float64, 0, 0) != CE_None)
    throw IoError(fmt::format("{}: {}", path.string(), CPLGetLastErrorMsg()));
  int has = 0;
  const double missing = band->GetNoDataValue(&has);
  r.values.resize(rows.size());
  for (int j = 0; j < r.ny; ++j)
    for (int i = 0; i < r.nx; ++i) {
      const double v = rows[static_cast<std::size_t>(north_up ? r.ny - 1 - j : j) * static_cast<std::size_t>(r.nx) +
                            static_cast<std::size_t>(i)];
      r.values[static_cast<std::size_t>(j) * static_cast<std::size_t>(r.nx) + static_cast<std::size_t>(i)] =
          has != 0 && v == missing ? std::numeric_limits<double>::quiet_NaN() : v;
    }
  return r;
}

void write_raster(const std::filesystem::path& path, const Raster& r) {
  GDALAllRegister();
  GDALDriverManager* drivers = GetGDALDriverManager();
  const bool ascii = path.extension() == ".asc";
  GDALDriver* memory = drivers->GetDriverByName("MEM");
  GDALDriver* driver = drivers->GetDriverByName(ascii ? "AAIGrid" : "GTiff");
  if (memory == nullptr || driver == nullptr) throw IoError(path.string() + ": this GDAL lacks the driver for it");
  const Dataset data(memory->Create("", r.nx, r.ny, 1, GDT_Float64, nullptr));
  double t[6] = {r.x0, r.dx, 0, r.y0 + r.dy * r.ny, 0, -r.dy};
  data->SetGeoTransform(t);
  if (!r.projection.empty()) data->SetProjection(r.projection.c_str());
  if (r.time && !ascii) data->SetMetadataItem(time_item, fmt::format("{}", *r.time).c_str());
  GDALRasterBand* band = data->GetRasterBand(1);
  band->SetNoDataValue(no_data);
  std::vector<double> row(static_cast<std::size_t>(r.nx));
  for (int j = 0; j < r.ny; ++j) {
    for (int i = 0; i < r.nx; ++i) {
      const double v = r.values[static_cast<std::size_t>(r.ny - 1 - j) * static_cast<std::size_t>(r.nx) +
                                static_cast<std::size_t>(i)];
      row[static_cast<std::size_t>(i)] = std::isnan(v) ? no_data : v;
    }
    if (band->RasterIO(GF_Write, 0, j, r.nx, 1, row.data(), r.nx, 1, GDT_Float64, 0, 0) != CE_None)
      throw IoError(fmt::format("{}: {}", path.string(), CPLGetLastErrorMsg()));
  }
  char** options = nullptr;
  options =
      ascii ? CSLSetNameValue(options, "DECIMAL_PRECISION", "6") : CSLSetNameValue(options, "COMPRESS", "DEFLATE");
  CPLPushErrorHandler(CPLQuietErrorHandler);
  const Dataset written(driver->CreateCopy(path.c_str(), data.get(), FALSE, options, nullptr, nullptr));
  CPLPopErrorHandler();
  CSLDestroy(options);
  if (!written) throw IoError(fmt::format("{}: {}", path.string(), CPLGetLastErrorMsg()));
}

PolygonLayer read_polygons(const std::filesystem::path& path) {
  const Dataset data = open(path, GDAL_OF_VECTOR);
  OGRLayer* layer = data->GetLayerCount() > 0 ? data->GetLayer(0) : nullptr;
  if (layer == nullptr) throw InputError(path.string() + ": holds no layer");
  PolygonLayer out;
  if (const OGRSpatialReference* reference = layer->GetSpatialRef()) {
    char* wkt = nullptr;
    if (reference->exportToWkt(&wkt) == OGRERR_NONE) out.projection = wkt;
    CPLFree(wkt);
  }
  const int field = layer->GetLayerDefn()->GetFieldIndex("thickness");
  const auto add = [&](const OGRPolygon* shape, std::optional<double> thickness) {
    Polygon p{.rings = {}, .thickness = thickness};
    for (const OGRLinearRing* ring : *shape) {
      auto& points = p.rings.emplace_back();
      for (const OGRPoint& point : *ring) points.push_back({point.getX(), point.getY()});
    }
    out.polygons.push_back(std::move(p));
  };
  for (const auto& feature : *layer) {
    const OGRGeometry* shape = feature->GetGeometryRef();
    if (shape == nullptr) continue;
    std::optional<double> thickness;
    if (field >= 0 && feature->IsFieldSetAndNotNull(field)) thickness = feature->GetFieldAsDouble(field);
    const auto type = wkbFlatten(shape->getGeometryType());
    if (type == wkbPolygon) add(shape->toPolygon(), thickness);
    if (type == wkbMultiPolygon)
      for (const OGRPolygon* part : *shape->toMultiPolygon()) add(part, thickness);
  }
  if (out.polygons.empty()) throw InputError(path.string() + ": holds no polygon");
  return out;
}

bool contains(const Polygon& polygon, double x, double y) {
  bool inside = false;
  for (const auto& ring : polygon.rings)
    for (std::size_t k = 0; k + 1 < ring.size(); ++k) {
      const auto &a = ring[k], &b = ring[k + 1];
      if ((a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) * (b[0] - a[0]) / (b[1] - a[1])) inside = !inside;
    }
  return inside;
}

bool same_projection(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return true;
  OGRSpatialReference first, second;
  if (first.importFromWkt(a.c_str()) != OGRERR_NONE || second.importFromWkt(b.c_str()) != OGRERR_NONE) return a == b;
  const char* options[] = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", "CRITERION=EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS",
                           nullptr};
  return first.IsSame(&second, options) != 0;
}

bool in_degrees(const std::string& projection) {
  OGRSpatialReference reference;
  return reference.importFromWkt(projection.c_str()) == OGRERR_NONE && reference.IsGeographic() != 0;
}

}  // namespace bagnold::io

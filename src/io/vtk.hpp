// Files for ParaView and OVITO: XML VTK, data inline as uncompressed base64, little-endian, because that is
// what both read. A .pvd file lists the files of a series with their times.
//
// OVITO recognises particle properties by name: id, type, radius, mass, v, omega, f, tq.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/vec3.hpp"

namespace bagnold::io {

// One array of a file: a number or a vector per point or cell. The data is only looked at while writing.
struct VtkArray {
  std::string name;
  std::variant<std::span<const double>, std::span<const Vec3>, std::span<const std::int32_t>,
               std::span<const std::int64_t>, std::span<const std::uint8_t>>
      data;
};

// .vtp: a cloud of points, for example grains.
void write_vtp_points(const std::filesystem::path& path, std::span<const Vec3> points,
                      const std::vector<VtkArray>& point_data);

// .vtp: line segments with data per segment, for example contacts with force and overlap.
void write_vtp_lines(const std::filesystem::path& path, std::span<const std::array<Vec3, 2>> segments,
                     const std::vector<VtkArray>& segment_data);

// .vti: a regular grid of cells; x varies fastest. A two-dimensional grid has cells[2] = 1.
struct ImageGrid {
  Vec3 origin;   // corner of the first cell
  Vec3 spacing;  // size of a cell
  std::array<std::int64_t, 3> cells;
  std::optional<double> time = std::nullopt;  // written as TimeValue, which ParaView shows
};
void write_vti(const std::filesystem::path& path, const ImageGrid& grid, const std::vector<VtkArray>& cell_data);

// .vts: a grid of points[0] x points[1] x points[2] nodes anywhere in space, x varies fastest; for example a
// surface draped over terrain (points[2] = 1).
void write_vts(const std::filesystem::path& path, const std::array<std::int64_t, 3>& points,
               std::span<const Vec3> nodes, const std::vector<VtkArray>& point_data);

// A .pvd collection. The file on disk is a complete XML document after every call.
class PvdSeries {
 public:
  // Starts an empty collection.
  static PvdSeries create(const std::filesystem::path& path);
  // Goes on with an existing one after dropping entries later than `until`; starts a new one when there is
  // none. Throws IoError when the file is not one written by this class.
  static PvdSeries resume(const std::filesystem::path& path, double until);
  // `file` is relative to the folder of the collection.
  void add(double time, const std::string& file);
  const std::vector<std::pair<double, std::string>>& entries() const { return entries_; }

 private:
  explicit PvdSeries(std::filesystem::path path) : path_(std::move(path)) {}
  void write() const;
  std::filesystem::path path_;
  std::vector<std::pair<double, std::string>> entries_;
};

// RFC 4648, with padding.
std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace bagnold::io

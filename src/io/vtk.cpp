#include "io/vtk.hpp"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cstring>
#include <numeric>
#include <string_view>

#include "core/error.hpp"
#include "io/escape.hpp"
#include "io/files.hpp"

namespace bagnold::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the files say LittleEndian");

std::string unescaped(std::string text) {
  constexpr std::array<std::pair<std::string_view, char>, 4> entities{
      {{"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&amp;", '&'}}};
  for (std::size_t at = text.find('&'); at != std::string::npos; at = text.find('&', at + 1))
    for (const auto& [entity, c] : entities)
      if (text.compare(at, entity.size(), entity) == 0) {
        text.replace(at, entity.size(), 1, c);
        break;
      }
  return text;
}

template <class T>
constexpr std::string_view vtk_type() {
  if constexpr (std::is_same_v<T, std::int32_t>) return "Int32";
  if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "UInt8";
  return "Float64";  // double, Vec3
}

// <DataArray> of `values`: base64 of the length in bytes, then the bytes.
template <class T>
void append_array(std::string& xml, std::string_view name, std::span<const T> values) {
  const std::uint64_t bytes = values.size_bytes();
  std::vector<std::uint8_t> block(sizeof bytes + bytes);
  std::memcpy(block.data(), &bytes, sizeof bytes);
  if (bytes > 0) std::memcpy(block.data() + sizeof bytes, values.data(), bytes);
  fmt::format_to(std::back_inserter(xml),
                 "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">\n", vtk_type<T>(),
                 escaped(name), std::is_same_v<T, Vec3> ? 3 : 1);
  xml += base64(block);
  xml += "\n</DataArray>\n";
}

void append_data(std::string& xml, std::string_view section, const std::vector<VtkArray>& arrays, std::size_t expected,
                 const std::filesystem::path& path) {
  fmt::format_to(std::back_inserter(xml), "<{}>\n", section);
  for (const auto& array : arrays)
    std::visit(
        [&](const auto& values) {
          if (values.size() != expected)
            throw IoError(fmt::format("{}: error: array '{}' has {} values, expected {}", path.string(), array.name,
                                      values.size(), expected));
          append_array(xml, array.name, values);
        },
        array.data);
  fmt::format_to(std::back_inserter(xml), "</{}>\n", section);
}

void append_points(std::string& xml, std::span<const Vec3> points) {
  xml += "<Points>\n";
  append_array(xml, "points", points);
  xml += "</Points>\n";
}

// Cells of `size` consecutive points each.
void append_cells(std::string& xml, std::string_view kind, std::size_t cells, std::int64_t size) {
  std::vector<std::int64_t> connectivity(cells * static_cast<std::size_t>(size)), offsets(cells);
  std::iota(connectivity.begin(), connectivity.end(), std::int64_t{0});
  for (std::size_t k = 0; k < cells; ++k) offsets[k] = size * static_cast<std::int64_t>(k + 1);
  fmt::format_to(std::back_inserter(xml), "<{}>\n", kind);
  append_array<std::int64_t>(xml, "connectivity", connectivity);
  append_array<std::int64_t>(xml, "offsets", offsets);
  fmt::format_to(std::back_inserter(xml), "</{}>\n", kind);
}

std::string document(std::string_view kind, std::string_view attributes, std::string_view content) {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n"
      "<{0}{1}>\n{2}</{0}>\n</VTKFile>\n",
      kind, attributes, content);
}

}  // namespace

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - k);
    std::uint32_t group = 0;
    for (std::size_t b = 0; b < 3; ++b) group = group << 8 | (b < left ? bytes[k + b] : 0u);
    for (std::size_t d = 0; d < 4; ++d) text += d <= left ? digits[group >> (18 - 6 * d) & 63] : '=';
  }
  return text;
}

void write_vtp_points(const std::filesystem::path& path, std::span<const Vec3> points,
                      const std::vector<VtkArray>& point_data) {
  const auto n = points.size();
  std::string xml = fmt::format(
      "<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n",
      n);
  append_data(xml, "PointData", point_data, n, path);
  append_points(xml, points);
  append_cells(xml, "Verts", n, 1);
  xml += "</Piece>\n";
  write_file(path, document("PolyData", "", xml));
}

void write_vtp_lines(const std::filesystem::path& path, std::span<const std::array<Vec3, 2>> segments,
                     const std::vector<VtkArray>& segment_data) {
  const auto n = segments.size();
  std::vector<Vec3> points;
  points.reserve(2 * n);
  for (const auto& [from, to] : segments) {
    points.push_back(from);
    points.push_back(to);
  }
  std::string xml = fmt::format(
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n",
      2 * n, n);
  append_data(xml, "CellData", segment_data, n, path);
  append_points(xml, points);
  append_cells(xml, "Lines", n, 2);
  xml += "</Piece>\n";
  write_file(path, document("PolyData", "", xml));
}

void write_vti(const std::filesystem::path& path, const ImageGrid& grid, const std::vector<VtkArray>& cell_data) {
  const auto& [origin, spacing, cells, time] = grid;
  const auto extent = fmt::format("0 {} 0 {} 0 {}", cells[0], cells[1], cells[2]);
  std::string xml;
  if (time)
    xml = fmt::format(
        "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{}"
        "</DataArray>\n</FieldData>\n",
        *time);
  fmt::format_to(std::back_inserter(xml), "<Piece Extent=\"{}\">\n", extent);
  append_data(xml, "CellData", cell_data, static_cast<std::size_t>(cells[0] * cells[1] * cells[2]), path);
  xml += "</Piece>\n";
  write_file(path, document("ImageData",
                            fmt::format(" WholeExtent=\"{}\" Origin=\"{} {} {}\" Spacing=\"{} {} {}\"", extent,
                                        origin.x, origin.y, origin.z, spacing.x, spacing.y, spacing.z),
                            xml));
}

void write_vts(const std::filesystem::path& path, const std::array<std::int64_t, 3>& points,
               std::span<const Vec3> nodes, const std::vector<VtkArray>& point_data) {
  const auto n = static_cast<std::size_t>(points[0] * points[1] * points[2]);
  if (nodes.size() != n) throw IoError(fmt::format("{}: error: {} nodes, expected {}", path.string(), nodes.size(), n));
  const auto extent = fmt::format("0 {} 0 {} 0 {}", points[0] - 1, points[1] - 1, points[2] - 1);
  std::string xml = fmt::format("<Piece Extent=\"{}\">\n", extent);
  append_data(xml, "PointData", point_data, n, path);
  append_points(xml, nodes);
  xml += "</Piece>\n";
  write_file(path, document("StructuredGrid", fmt::format(" WholeExtent=\"{}\"", extent), xml));
}

PvdSeries PvdSeries::create(const std::filesystem::path& path) {
  PvdSeries series(path);
  series.write();
  return series;
}

PvdSeries PvdSeries::resume(const std::filesystem::path& path, double until) {
  if (!std::filesystem::exists(path)) return create(path);
  const auto text = read_file(path);
  if (text.find("</Collection>") == std::string::npos)
    throw IoError(fmt::format("{}: error: not a complete .pvd collection", path.string()));
  PvdSeries series(path);
  constexpr std::string_view before_time = "<DataSet timestep=\"", before_file = "file=\"";
  for (auto at = text.find(before_time); at != std::string::npos; at = text.find(before_time, at + 1)) {
    double time = 0;
    const char* begin = text.data() + at + before_time.size();
    const auto file = text.find(before_file, at);
    const auto end = file == std::string::npos ? file : text.find('"', file + before_file.size());
    if (std::from_chars(begin, text.data() + text.size(), time).ec != std::errc() || end == std::string::npos)
      throw IoError(fmt::format("{}: error: an entry of the .pvd collection cannot be read", path.string()));
    if (time > until) continue;
    series.entries_.emplace_back(time,
                                 unescaped(text.substr(file + before_file.size(), end - file - before_file.size())));
  }
  series.write();
  return series;
}

void PvdSeries::add(double time, const std::string& file) {
  entries_.emplace_back(time, file);
  write();
}

void PvdSeries::write() const {
  std::string xml;
  for (const auto& [time, file] : entries_)
    fmt::format_to(std::back_inserter(xml), "<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", time, escaped(file));
  write_file(path_,
             "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
             "byte_order=\"LittleEndian\">\n<Collection>\n" +
                 xml + "</Collection>\n</VTKFile>\n");
}

}  // namespace bagnold::io

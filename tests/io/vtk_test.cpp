#include "io/vtk.hpp"

#include <cstring>

#include "core/error.hpp"
#include "io/files.hpp"
#include "scratch.hpp"

namespace bagnold::io {
namespace {

std::vector<std::uint8_t> from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int have = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    if ((have += 6) >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> (have -= 8) & 255));
  }
  return bytes;
}

// The numbers of the array called `name`, read as the format defines it, independently of the writer.
template <class T>
std::vector<T> decode(const std::string& xml, const std::string& type, const std::string& name) {
  const auto tag = xml.find("<DataArray type=\"" + type + "\" Name=\"" + name + "\"");
  if (tag == std::string::npos) return {};
  const auto begin = xml.find(">\n", tag) + 2;
  const auto bytes = from_base64(xml.substr(begin, xml.find('\n', begin) - begin));
  std::uint64_t length = 0;
  std::memcpy(&length, bytes.data(), 8);
  EXPECT_EQ(length + 8, bytes.size());
  std::vector<T> values(length / sizeof(T));
  std::memcpy(values.data(), bytes.data() + 8, length);
  return values;
}

TEST(Vtk, Base64IsThatOfTheRfc) {
  const auto encode = [](const std::string& s) {
    return base64({reinterpret_cast<const std::uint8_t*>(s.data()), s.size()});
  };
  EXPECT_EQ(encode(""), "");
  EXPECT_EQ(encode("f"), "Zg==");
  EXPECT_EQ(encode("fo"), "Zm8=");
  EXPECT_EQ(encode("foo"), "Zm9v");
  EXPECT_EQ(encode("foobar"), "Zm9vYmFy");
}

TEST(Vtk, PointsComeBackBitForBit) {
  const Scratch dir;
  const std::vector<Vec3> x{{0.1, -0.0, 5e-324}, {1e300, 2, 3}}, v{{1, 0, 0}, {0, 1.0 / 3, 0}};
  const std::vector<double> radius{0.5, 0.25};
  const std::vector<std::int64_t> id{7, 8};
  const std::vector<std::int32_t> type{0, 1};
  write_vtp_points(dir / "g.vtp", x, {{"id", id}, {"type", type}, {"radius", radius}, {"v", v}});
  const auto xml = read_file(dir / "g.vtp");
  EXPECT_EQ(decode<Vec3>(xml, "Float64", "points"), x);
  EXPECT_EQ(decode<Vec3>(xml, "Float64", "v"), v);
  EXPECT_EQ(decode<double>(xml, "Float64", "radius"), radius);
  EXPECT_EQ(decode<std::int64_t>(xml, "Int64", "id"), id);
  EXPECT_EQ(decode<std::int32_t>(xml, "Int32", "type"), type);
  EXPECT_EQ(decode<std::int64_t>(xml, "Int64", "connectivity"), (std::vector<std::int64_t>{0, 1}));
  EXPECT_EQ(decode<std::int64_t>(xml, "Int64", "offsets"), (std::vector<std::int64_t>{1, 2}));
  EXPECT_TRUE(contains(xml, "NumberOfPoints=\"2\" NumberOfVerts=\"2\""));  // what OVITO asks for
}

TEST(Vtk, SegmentsCarryDataPerCell) {
  const Scratch dir;
  const std::vector<std::array<Vec3, 2>> segments{{Vec3{0, 0, 0}, Vec3{1, 0, 0}}, {Vec3{0, 0, 1}, Vec3{0, 1, 0}}};
  const std::vector<double> overlap{0.01, 0.02};
  write_vtp_lines(dir / "c.vtp", segments, {{"overlap", overlap}});
  const auto xml = read_file(dir / "c.vtp");
  EXPECT_EQ(decode<Vec3>(xml, "Float64", "points"), (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}}));
  EXPECT_EQ(decode<std::int64_t>(xml, "Int64", "connectivity"), (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(decode<std::int64_t>(xml, "Int64", "offsets"), (std::vector<std::int64_t>{2, 4}));
  EXPECT_EQ(decode<double>(xml, "Float64", "overlap"), overlap);
  EXPECT_LT(xml.find("<CellData>"), xml.find("\"overlap\""));
}

TEST(Vtk, Grids) {
  const Scratch dir;
  const std::vector<double> h{1, 2, 3, 4, 5, 6};
  write_vti(dir / "h.vti", {.origin = {0, 1, 0}, .spacing = {0.5, 0.5, 1}, .cells = {3, 2, 1}}, {{"h", h}});
  auto xml = read_file(dir / "h.vti");
  EXPECT_TRUE(contains(xml, "WholeExtent=\"0 3 0 2 0 1\" Origin=\"0 1 0\" Spacing=\"0.5 0.5 1\""));
  EXPECT_EQ(decode<double>(xml, "Float64", "h"), h);
  EXPECT_FALSE(contains(xml, "TimeValue"));
  write_vti(dir / "t.vti", {.origin = {}, .spacing = {1, 1, 1}, .cells = {3, 2, 1}, .time = 4.98}, {{"h", h}});
  xml = read_file(dir / "t.vti");
  EXPECT_TRUE(contains(xml, "Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">4.98<"));
  EXPECT_LT(xml.find("<FieldData>"), xml.find("<Piece"));
  std::vector<Vec3> nodes;
  for (int k = 0; k < 6; ++k) nodes.push_back({double(k % 3), double(k / 3), 0.1 * k});
  write_vts(dir / "s.vts", {3, 2, 1}, nodes, {{"h", h}});
  xml = read_file(dir / "s.vts");
  EXPECT_TRUE(contains(xml, "WholeExtent=\"0 2 0 1 0 0\""));
  EXPECT_EQ(decode<Vec3>(xml, "Float64", "points"), nodes);
}

TEST(Vtk, WrongLengthsAreErrors) {
  const Scratch dir;
  const std::vector<Vec3> x(2);
  const std::vector<double> radius(3);
  EXPECT_TRUE(contains(error_of<IoError>([&] {
                         write_vtp_points(dir / "g.vtp", x, {{"radius", radius}});
                       }),
                       "'radius' has 3 values, expected 2"));
  EXPECT_FALSE(std::filesystem::exists(dir / "g.vtp"));
  EXPECT_TRUE(contains(error_of<IoError>([&] { write_vts(dir / "s.vts", {3, 1, 1}, x, {}); }), "2 nodes, expected 3"));
}

TEST(Pvd, IsACompleteDocumentAfterEveryEntryAndResumesByTime) {
  const Scratch dir;
  const std::string end = "</Collection>\n</VTKFile>\n";
  auto series = PvdSeries::create(dir / "g.pvd");
  EXPECT_TRUE(read_file(dir / "g.pvd").ends_with(end));
  for (const double t : {0.0, 0.1, 0.2, 0.30000000000000004}) {
    series.add(t, "grains & \"base\" <1>.vtp");
    EXPECT_TRUE(read_file(dir / "g.pvd").ends_with(end));
  }
  const auto resumed = PvdSeries::resume(dir / "g.pvd", 0.2);
  ASSERT_EQ(resumed.entries().size(), 3u);
  EXPECT_EQ(resumed.entries()[1], (std::pair<double, std::string>(0.1, "grains & \"base\" <1>.vtp")));
  EXPECT_FALSE(contains(read_file(dir / "g.pvd"), "0.30000000000000004"));
  EXPECT_TRUE(contains(read_file(dir / "g.pvd"),
                       "timestep=\"0.1\" part=\"0\" file=\"grains &amp; &quot;base&quot; &lt;1&gt;.vtp\"/>"));
  EXPECT_TRUE(PvdSeries::resume(dir / "new.pvd", 1).entries().empty());
  write_file(dir / "bad.pvd", "<VTKFile>");
  EXPECT_TRUE(contains(error_of<IoError>([&] { PvdSeries::resume(dir / "bad.pvd", 1); }), "not a complete"));
}

}  // namespace
}  // namespace bagnold::io

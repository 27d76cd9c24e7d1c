#include "io/hdf5.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "io/files.hpp"
#include "io/provenance.hpp"
#include "scratch.hpp"

namespace bagnold::io {
namespace {

const std::vector<double> awkward{0.1,
                                  -0.0,
                                  1e-310,
                                  std::numeric_limits<double>::max(),
                                  std::nextafter(1.0, 2.0),
                                  std::numeric_limits<double>::infinity()};

TEST(H5File, ReturnsTheSameBits) {
  const Scratch dir;
  const std::vector<Vec3> points{{1, 2, 3}, {-0.1, 1e300, 5e-324}};
  const std::vector<std::int64_t> ids{std::numeric_limits<std::int64_t>::min(), -1,
                                      std::numeric_limits<std::int64_t>::max()};
  {
    auto file = H5File::create(dir / "a.h5");
    file.write("a/b/numbers", awkward);
    file.write("points", points);
    file.write("ids", ids);
    file.write("small", std::vector<std::int32_t>{-7, 7});
    file.write("bytes", std::vector<std::uint8_t>{0, 255});
    file.write("single", std::vector<float>{0.1f});
    file.write("none", std::vector<Vec3>{});
    file.close();
  }
  const auto file = H5File::read_only(dir / "a.h5");
  const auto numbers = file.read<double>("a/b/numbers");
  ASSERT_EQ(numbers.size(), awkward.size());
  for (std::size_t k = 0; k < numbers.size(); ++k)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(numbers[k]), std::bit_cast<std::uint64_t>(awkward[k]));
  EXPECT_EQ(file.read<Vec3>("points"), points);
  EXPECT_EQ(file.read<std::int64_t>("ids"), ids);
  EXPECT_EQ(file.read<std::int32_t>("small"), (std::vector<std::int32_t>{-7, 7}));
  EXPECT_EQ(file.read<std::uint8_t>("bytes"), (std::vector<std::uint8_t>{0, 255}));
  EXPECT_EQ(file.read<float>("single"), std::vector<float>{0.1f});
  EXPECT_TRUE(file.read<Vec3>("none").empty());
  EXPECT_EQ(file.dims("points"), (Dims{2, 3}));
  EXPECT_EQ(file.children("/"), (std::vector<std::string>{"a", "bytes", "ids", "none", "points", "single", "small"}));
  EXPECT_TRUE(file.exists("a/b") && file.exists("/a/b/numbers") && !file.exists("a/c/numbers"));
}

TEST(H5File, CompressionChangesTheSizeNotTheBits) {
  const Scratch dir;
  std::vector<double> ramp(300'000);
  for (std::size_t k = 0; k < ramp.size(); ++k) ramp[k] = std::floor(static_cast<double>(k) / 100);
  auto file = H5File::create(dir / "a.h5");
  file.write("ramp", ramp, {1000, 300}, Compress::yes);
  file.write("empty", std::vector<double>{}, {}, Compress::yes);
  file.flush();
  EXPECT_LT(std::filesystem::file_size(dir / "a.h5"), ramp.size() * sizeof(double) / 10);
  EXPECT_EQ(file.read<double>("ramp"), ramp);
  EXPECT_EQ(file.dims("ramp"), (Dims{1000, 300}));
}

TEST(H5File, SameCallsSameBytes) {
  const Scratch dir;
  for (const char* name : {"a.h5", "b.h5"}) {
    auto file = H5File::create(dir / name);
    file.write("x/y", awkward, {}, Compress::yes);
    write_provenance(file, provenance(7, "seed = 7\n"));
    file.close();
    if (name[0] == 'a') ::sleep(1);  // a stored time of writing would differ
  }
  EXPECT_TRUE(read_file(dir / "a.h5") == read_file(dir / "b.h5"));
}

TEST(H5File, Attributes) {
  const Scratch dir;
  const std::string long_text(100'000, 'x');
  {
    auto file = H5File::create(dir / "a.h5");
    file.write("x", awkward);
    file.attribute("x", "unit", "m/s²");
    file.attribute("x", "unit", "m/s");  // replaces
    file.attribute("/", "input", long_text);
    file.attribute("/", "empty", "");
    file.attribute("snapshots/0001", "t", 0.1);
    file.attribute("snapshots/0001", "step", 1'234'567'890'123);
  }
  const auto file = H5File::read_only(dir / "a.h5");
  EXPECT_EQ(file.string_attribute("x", "unit"), "m/s");
  EXPECT_EQ(file.string_attribute("/", "input"), long_text);
  EXPECT_EQ(file.string_attribute("/", "empty"), "");
  EXPECT_EQ(file.double_attribute("snapshots/0001", "t"), 0.1);
  EXPECT_EQ(file.int_attribute("snapshots/0001", "step"), 1'234'567'890'123);
  EXPECT_FALSE(file.has_attribute("x", "t"));
  EXPECT_TRUE(contains(error_of<IoError>([&] { file.int_attribute("x", "unit"); }), "unit has another type"));
  EXPECT_TRUE(contains(error_of<IoError>([&] { file.double_attribute("x", "t"); }), "'x': no attribute t"));
}

TEST(H5File, ReplacesRemovesAndGoesOn) {
  const Scratch dir;
  H5File::append(dir / "a.h5").write("s/1/x", std::vector<double>{1});
  {
    auto file = H5File::append(dir / "a.h5");
    file.write("s/1/x", std::vector<std::int32_t>{1, 2});
    file.write("s/2/x", std::vector<double>{3});
  }
  auto file = H5File::append(dir / "a.h5");
  EXPECT_EQ(file.read<std::int32_t>("s/1/x"), (std::vector<std::int32_t>{1, 2}));
  file.remove("s/2");
  EXPECT_EQ(file.children("s"), std::vector<std::string>{"1"});
}

TEST(H5File, FlushedDataSurvivesAKill) {
  const Scratch dir;
  const pid_t child = ::fork();
  if (child == 0) {
    auto file = H5File::create(dir / "a.h5");
    file.write("s/1/x", awkward);
    file.flush();
    file.write("s/2/x", awkward);
    ::_exit(0);  // no destructor, no exit handler: as by SIGKILL
  }
  ::waitpid(child, nullptr, 0);
  EXPECT_EQ(H5File::read_only(dir / "a.h5").read<double>("s/1/x"), awkward);
}

TEST(H5File, ErrorsNameTheFileAndTheDataset) {
  const Scratch dir;
  auto file = H5File::create(dir / "a.h5");
  file.write("x", std::vector<double>{0.5});
  file.write("big", std::vector<std::int64_t>{1});
  const auto name = (dir / "a.h5").string();
  EXPECT_TRUE(contains(error_of<IoError>([&] { file.read<double>("g/y"); }), name + ": error: 'g/y': no such dataset"));
  EXPECT_TRUE(contains(error_of<IoError>([&] { file.read<std::int64_t>("x"); }), "do not fit"));
  EXPECT_TRUE(contains(error_of<IoError>([&] { file.read<std::int32_t>("big"); }), "do not fit"));
  EXPECT_TRUE(contains(error_of<IoError>([&] { file.read<Vec3>("x"); }), "n x 3"));
  EXPECT_TRUE(contains(error_of<IoError>([&] {
                         file.write("y", std::vector<double>{1, 2, 3}, {2, 2});
                       }),
                       "'y': 3 values"));
  EXPECT_TRUE(contains(error_of<IoError>([&] { H5File::read_only(dir / "none.h5"); }), "no such file"));
  write_file(dir / "text.h5", "not HDF5");
  EXPECT_TRUE(contains(error_of<IoError>([&] { H5File::read_only(dir / "text.h5"); }), "not a readable HDF5 file"));
  EXPECT_TRUE(contains(error_of<IoError>([&] { H5File::create(dir / "no/such/a.h5"); }), "cannot create"));
}

TEST(Provenance, RoundTrip) {
  const Scratch dir;
  const auto written = provenance(-3, "model = \"dem\"\n");
  auto file = H5File::create(dir / "a.h5");
  write_provenance(file, written);
  const auto read = read_provenance(file);
  EXPECT_EQ(read.seed, -3);
  EXPECT_EQ(read.input, written.input);
  EXPECT_EQ(read.version, written.version);
  EXPECT_EQ(read.git_hash, written.git_hash);
  EXPECT_EQ(read.compiler, written.compiler);
}

}  // namespace
}  // namespace bagnold::io

#include "io/checkpoint.hpp"

#include <fstream>

#include "core/error.hpp"
#include "io/files.hpp"
#include "io/hdf5.hpp"
#include "scratch.hpp"

namespace bagnold::io {
namespace {

struct State {
  std::vector<double> radius{0.1, 0.2, 0.3};
  std::vector<Vec3> x{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  std::vector<std::int32_t> species{0, 1, 1};
  std::vector<std::int64_t> id{10, 11, 12};
  std::vector<std::uint8_t> touching;
  double t = 0.1;
  std::int64_t step = 5;
  friend bool operator==(const State&, const State&) = default;

  std::vector<NamedArray> arrays() {
    return {{"grains/radius", &radius},
            {"grains/x", &x},
            {"grains/species", &species},
            {"grains/id", &id},
            {"contacts/touching", &touching},
            {"t", &t},
            {"step", &step}};
  }
};

const State blank{.radius = {}, .x = {{0, 0, 0}}, .species = {}, .id = {}, .touching = {1}, .t = 0, .step = 0};

State at_step(std::int64_t step) {
  State state;
  state.step = step;
  state.t = 0.1 * static_cast<double>(step);
  state.x[1].z = state.t / 3;
  return state;
}

void write(const Scratch& dir, State state) { write_checkpoint(dir.path, state.arrays(), provenance(1, "seed = 1\n")); }

void overwrite_middle(const std::filesystem::path& path, std::size_t from, std::size_t bytes) {
  auto content = read_file(path);
  for (std::size_t k = from; k < std::min(content.size(), from + bytes); ++k)
    content[k] = static_cast<char>(~content[k]);
  std::ofstream(path, std::ios::binary) << content;
}

TEST(Checkpoint, RestoresTheState) {
  const Scratch dir;
  write(dir, at_step(3));
  auto state = blank;
  const auto from = read_checkpoint(dir.path, state.arrays());
  EXPECT_EQ(state, at_step(3));
  EXPECT_FALSE(from.previous);
  EXPECT_EQ(from.provenance.input, "seed = 1\n");
  EXPECT_EQ(checkpoint_provenance(dir.path).seed, 1);
}

TEST(Checkpoint, KeepsThePreviousOne) {
  const Scratch dir;
  for (const std::int64_t step : {1, 2, 3}) write(dir, at_step(step));
  std::filesystem::remove(dir / "checkpoint.h5");
  auto state = blank;
  EXPECT_TRUE(read_checkpoint(dir.path, state.arrays()).previous);
  EXPECT_EQ(state, at_step(2));
}

TEST(Checkpoint, TruncationAnywhereFallsBackToThePreviousOne) {
  const Scratch dir;
  write(dir, at_step(1));
  write(dir, at_step(2));
  const auto whole = read_file(dir / "checkpoint.h5");
  for (std::size_t size = 0; size < whole.size(); size += whole.size() / 40) {
    std::ofstream(dir / "checkpoint.h5", std::ios::binary) << whole.substr(0, size);
    auto state = blank;
    const auto from = read_checkpoint(dir.path, state.arrays());
    ASSERT_TRUE(from.previous) << "cut to " << size << " bytes";
    ASSERT_EQ(state, at_step(1));
    ASSERT_TRUE(contains(from.damage, "checkpoint.h5"));
  }
}

// One flipped byte in the data of an array is caught by its checksum.
TEST(Checkpoint, AFlippedByteInTheDataFallsBackToThePreviousOne) {
  const Scratch dir;
  write(dir, at_step(1));
  write(dir, at_step(2));
  const auto content = read_file(dir / "checkpoint.h5");
  const double seven = 7;
  const auto at = content.find(std::string(reinterpret_cast<const char*>(&seven), sizeof seven));
  ASSERT_NE(at, std::string::npos);
  overwrite_middle(dir / "checkpoint.h5", at + 1, 1);
  auto state = blank;
  const auto from = read_checkpoint(dir.path, state.arrays());
  EXPECT_TRUE(from.previous);
  EXPECT_TRUE(contains(from.damage, "'state/grains/x': the checksum does not match"));
  EXPECT_EQ(state, at_step(1));
}

TEST(Checkpoint, AnInterruptedWriteLeavesTheOldOnes) {
  const Scratch dir;
  write(dir, at_step(1));
  std::ofstream(dir / "checkpoint.h5.part") << "half";
  auto state = blank;
  EXPECT_FALSE(read_checkpoint(dir.path, state.arrays()).previous);
  EXPECT_EQ(state, at_step(1));
  write(dir, at_step(2));
  EXPECT_FALSE(std::filesystem::exists(dir / "checkpoint.h5.part"));
}

TEST(Checkpoint, NothingToReadIsAnIoErrorAndChangesNothing) {
  const Scratch dir;
  auto state = blank;
  EXPECT_TRUE(
      contains(error_of<IoError>([&] { read_checkpoint(dir.path, state.arrays()); }), "no checkpoint can be read"));
  write(dir, at_step(1));
  overwrite_middle(dir / "checkpoint.h5", 0, 64);
  EXPECT_TRUE(
      contains(error_of<IoError>([&] { read_checkpoint(dir.path, state.arrays()); }), "not a readable HDF5 file"));
  EXPECT_EQ(state, blank);
}

TEST(Checkpoint, AnotherModelsStateIsAnInputErrorNamingTheArray) {
  const Scratch dir;
  write(dir, at_step(1));
  auto state = blank;
  std::vector<double> extra;
  auto more = state.arrays();
  more.push_back({"grains/charge", &extra});
  EXPECT_TRUE(contains(error_of<InputError>([&] { read_checkpoint(dir.path, more); }), "no array 'grains/charge'"));
  auto fewer = state.arrays();
  fewer.erase(fewer.begin());
  EXPECT_TRUE(
      contains(error_of<InputError>([&] { read_checkpoint(dir.path, fewer); }), "unexpected array 'grains/radius'"));
  auto other = state.arrays();
  other[0].array = &state.t;
  EXPECT_TRUE(contains(error_of<InputError>([&] { read_checkpoint(dir.path, other); }),
                       "'grains/radius' is not a single number"));
  EXPECT_EQ(state, blank);
}

}  // namespace
}  // namespace bagnold::io

#include "io/json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "io/files.hpp"
#include "scratch.hpp"

namespace bagnold::io {
namespace {

TEST(Json, NumbersThatDoNotExistAreNullAndTheRestIsExact) {
  const Scratch dir;
  write_json(dir / "a.json", nlohmann::json{{"h", 0.1 + 0.2}, {"angle", std::nan("")}, {"grains", 2000}});
  const auto read = read_json(dir / "a.json");
  EXPECT_EQ(read["h"].get<double>(), 0.1 + 0.2);
  EXPECT_TRUE(read["angle"].is_null());
  EXPECT_EQ(read["grains"], 2000);
  EXPECT_FALSE(std::filesystem::exists(dir / "a.json.part"));
}

TEST(Json, OrderedKeysStayInOrder) {
  const Scratch dir;
  write_json(dir / "a.json", nlohmann::ordered_json{{"z", 1}, {"a", 2}});
  EXPECT_EQ(read_file(dir / "a.json"), "{\n  \"z\": 1,\n  \"a\": 2\n}\n");
}

TEST(Json, Errors) {
  const Scratch dir;
  write_file(dir / "a.json", "{\n \"a\": }\n");
  EXPECT_TRUE(contains(error_of<IoError>([&] { read_json(dir / "a.json"); }), "line 2"));
}

TEST(Files, WritingReplacesOrLeavesTheOldFile) {
  const Scratch dir;
  write_file(dir / "a", "one");
  write_file(dir / "a", "two");
  EXPECT_EQ(read_file(dir / "a"), "two");
  std::filesystem::create_directory(dir / "a.part");  // the new file cannot be built
  EXPECT_TRUE(contains(error_of<IoError>([&] { write_file(dir / "a", "three"); }), "cannot create"));
  EXPECT_EQ(read_file(dir / "a"), "two");
  EXPECT_TRUE(contains(error_of<IoError>([&] { read_file(dir.path); }), "cannot read"));
}

}  // namespace
}  // namespace bagnold::io

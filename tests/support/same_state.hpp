// Compares the exact states of two run directories.
#pragma once
#include <functional>

#include "core/error.hpp"
#include "io/hdf5.hpp"
#include "support/program.hpp"

namespace bagnold::test {

// Every array of the exact state but the clocks.
inline void expect_same_state(const fs::path& a, const fs::path& b) {
  const auto first = io::H5File::read_only(a / "checkpoint.h5"), second = io::H5File::read_only(b / "checkpoint.h5");
  std::size_t compared = 0;
  const std::function<void(const std::string&)> walk = [&](const std::string& group) {
    const auto names = first.children(group);
    EXPECT_EQ(names, second.children(group));
    for (const std::string& name : names) {
      const std::string path = group == "/" ? name : group + "/" + name;
      if (path.find("wall_s") != std::string::npos || path.find("cpu_s") != std::string::npos) continue;
      try {
        (void)first.dims(path);
      } catch (const IoError&) {  // a group
        walk(path);
        continue;
      }
      try {
        EXPECT_TRUE(first.read<double>(path) == second.read<double>(path)) << path;
      } catch (const IoError&) {  // integers are not read as floating point
        EXPECT_EQ(first.read<std::int64_t>(path), second.read<std::int64_t>(path)) << path;
      }
      ++compared;
    }
  };
  walk("/");
  EXPECT_GE(compared, 8u);
}

}  // namespace bagnold::test

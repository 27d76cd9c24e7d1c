// Runs the built program as a user would, in a scratch directory that is removed afterwards.
#pragma once
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace bagnold::test {

namespace fs = std::filesystem;

inline std::string read_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline void write_text(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

class Scratch {
 public:
  Scratch() {
    std::string name = (fs::temp_directory_path() / "bagnold-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no scratch directory");
    path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  fs::path operator/(const std::string& name) const { return path_ / name; }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

struct Outcome {
  int exit_code = -1;
  std::string out, err;
};

// `environment` goes before the command, for example "OMP_NUM_THREADS=2".
inline Outcome bagnold(const Scratch& scratch, const std::string& arguments, const std::string& environment = "") {
  // One thread: tiny runs gain nothing from two, and lose much where the machine is shared. A cache of our own:
  // beds are shared between tests, and nothing outside the build decides a result.
  const std::string command = "cd '" + scratch.path().string() +
                              "' && OMP_NUM_THREADS=1 XDG_CACHE_HOME='" BAGNOLD_TEST_CACHE "' " + environment +
                              " '" BAGNOLD_PROGRAM "' " + arguments + " >stdout.txt 2>stderr.txt </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, read_text(scratch / "stdout.txt"),
          read_text(scratch / "stderr.txt")};
}

// Runs `arguments` and sends `signal` as soon as `directory`/series.csv has more than `rows` rows: a moment of the run, not
// of the clock.
inline Outcome bagnold_cut(const Scratch& scratch, const std::string& arguments, const std::string& directory, int rows,
                           const std::string& signal = "TERM") {
  const std::string series = (scratch / directory / "series.csv").string();
  return bagnold(scratch, arguments + " & pid=$!; while kill -0 $pid && ! [ \"$(cat " + series + " | wc -l)\" -gt " +
                              std::to_string(rows + 1) + " ]; do sleep 0.02; done 2>/dev/null; kill -" + signal +
                              " $pid; wait $pid; exit $? #");
}

inline std::string case_file(const std::string& name) { return std::string(BAGNOLD_SOURCE_DIR "/cases/") + name; }

}  // namespace bagnold::test

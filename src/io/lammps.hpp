// Text dumps of LAMMPS: `dump custom` of atoms and `dump local` of contacts.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "core/vec3.hpp"

namespace bagnold::io {

// One instant of a dump.
struct LammpsFrame {
  std::int64_t step = 0;
  std::optional<double> time;  // if the dump says so (dump_modify time yes)
  Vec3 lo{}, hi{};
  std::array<bool, 3> periodic{};
  bool atoms = true;  // false: entries of a local dump
  std::vector<std::string> columns;
  std::vector<double> values;  // row-major
  std::size_t rows() const { return columns.empty() ? 0 : values.size() / columns.size(); }
  std::optional<std::size_t> find(const std::string& column) const;
  double at(std::size_t row, std::size_t column) const { return values[row * columns.size() + column]; }
};

// Reads a dump instant by instant.
class LammpsDump {
 public:
  explicit LammpsDump(const std::filesystem::path& path);  // throws IoError
  // The next instant; nothing at the end. Throws InputError with file and line where the file is not a dump,
  // or is one of a kind not supported (triclinic boxes, columns that are not numbers).
  std::optional<LammpsFrame> next();

 private:
  bool line(std::string& text);
  [[noreturn]] void fail(const std::string& what) const;
  void read_box(const std::string& header, LammpsFrame& frame);
  void read_rows(const std::string& header, std::size_t count, LammpsFrame& frame);

  std::filesystem::path path_;
  std::ifstream in_;
  std::int64_t line_ = 0;
};

}  // namespace bagnold::io

// What a report needs of a run directory, read.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "io/csv.hpp"

namespace bagnold::report {

struct RunData {
  std::string name;  // of the directory: tells runs apart in figures with several
  nlohmann::ordered_json summary;
  std::string input;  // case.toml
  std::optional<io::CsvTable> series, profile;
  std::optional<io::CsvTable> widths;      // solid fraction for several widths of the kernel
  std::optional<io::CsvTable> steadiness;  // momentum residual against averaging time
};

// Reads summary.json, case.toml and the tables that exist. Throws InputError when
// `directory` holds no finished or interrupted run, IoError when a file cannot be read.
RunData read_run(const std::filesystem::path& directory);

// summary.<section>.<key> as a number; NaN when it is absent or null.
double number(const RunData& run, const std::string& section, const std::string& key);

}  // namespace bagnold::report

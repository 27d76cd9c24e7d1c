#include "report/run_data.hpp"

#include <fmt/format.h>

#include <limits>

#include "core/error.hpp"
#include "io/files.hpp"

namespace bagnold::report {

RunData read_run(const std::filesystem::path& directory) {
  const auto summary = directory / "summary.json";
  if (!std::filesystem::exists(summary))
    throw InputError(
        fmt::format("{}: error: no summary.json, expected the directory of a run that has ended", directory.string()));
  RunData run;
  run.name = std::filesystem::weakly_canonical(directory).filename().string();
  try {
    run.summary = nlohmann::ordered_json::parse(io::read_file(summary));
  } catch (const nlohmann::json::parse_error& error) {
    throw IoError(fmt::format("{}: error: {}", summary.string(), error.what()));
  }
  run.input = io::read_file(directory / "case.toml");
  const auto table = [&](const char* name, io::CsvHeader header) -> std::optional<io::CsvTable> {
    if (!std::filesystem::exists(directory / name)) return std::nullopt;
    return io::read_csv(directory / name, header);
  };
  run.series = table("series.csv", io::CsvHeader::names);
  run.profile = table("profile.csv", io::CsvHeader::names_and_units);
  run.widths = table("widths.csv", io::CsvHeader::names_and_units);
  run.steadiness = table("steadiness.csv", io::CsvHeader::names_and_units);
  return run;
}

double number(const RunData& run, const std::string& section, const std::string& key) {
  const auto found = run.summary.find(section);
  if (found == run.summary.end() || !found->is_object()) return std::numeric_limits<double>::quiet_NaN();
  const auto value = found->find(key);
  if (value == found->end() || !value->is_number()) return std::numeric_limits<double>::quiet_NaN();
  return value->get<double>();
}

}  // namespace bagnold::report

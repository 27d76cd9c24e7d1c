#include "io/json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "io/files.hpp"

namespace bagnold::io {

void write_json(const std::filesystem::path& path, const nlohmann::json& value) {
  write_file(path, value.dump(2) + "\n");
}

void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& value) {
  write_file(path, value.dump(2) + "\n");
}

nlohmann::json read_json(const std::filesystem::path& path) {
  const auto text = read_file(path);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    throw IoError(fmt::format("{}: error: {}", path.string(), error.what()));
  }
}

}  // namespace bagnold::io

// JSON files: summary.json and the like.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace bagnold::io {

// Replaces `path` in one step. Keys come in alphabetical order (json) or as inserted (ordered_json); NaN and
// infinity become null: a number that does not exist is never 0. Throws IoError.
void write_json(const std::filesystem::path& path, const nlohmann::json& value);
void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& value);

// Throws IoError with line and column when the file cannot be read or is not JSON.
nlohmann::json read_json(const std::filesystem::path& path);

}  // namespace bagnold::io

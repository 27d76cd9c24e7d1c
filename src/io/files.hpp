// Whole files, written so that a reader or a crash never meets half of one.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace bagnold::io {

// The content of `path`. Throws IoError.
std::string read_file(const std::filesystem::path& path);

// Replaces `path` by `content` in one step: written next to it, renamed. Whoever reads meets the old or the new file
// whole, also after a crash of the program; what must survive a power cut (checkpoints) is synchronised by its writer.
// Throws IoError.
void write_file(const std::filesystem::path& path, std::string_view content);

// `path` with ".part" appended: where a file is built before it takes its name.
std::filesystem::path part_of(const std::filesystem::path& path);

// Forces the content of `path`, a file or a directory, to disk. Throws IoError.
void sync_to_disk(const std::filesystem::path& path);

// rename(2), then the directory is synchronised so that the new name survives a power cut. Throws IoError.
void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace bagnold::io

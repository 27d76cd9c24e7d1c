#include "io/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "core/error.hpp"

namespace bagnold::io {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view what) {
  throw IoError(fmt::format("{}: error: {}: {}", path.string(), what, std::strerror(errno)));
}

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path)) fail(path, "cannot read");
  std::string content{std::istreambuf_iterator<char>(in), {}};
  if (in.bad()) fail(path, "cannot read");
  return content;
}

void write_file(const std::filesystem::path& path, std::string_view content) {
  const auto part = part_of(path);
  {
    errno = 0;
    std::ofstream out(part, std::ios::binary | std::ios::trunc);
    if (!out) fail(path, "cannot create");
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
    out.close();
    if (!out) fail(path, "cannot write");
  }
  if (std::rename(part.c_str(), path.c_str()) != 0) fail(path, "cannot replace");
}

std::filesystem::path part_of(const std::filesystem::path& path) { return path.string() + ".part"; }

void sync_to_disk(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) fail(path, "cannot open to synchronise");
  const int result = ::fsync(file);
  const int error = errno;
  ::close(file);
  errno = error;
  if (result != 0 && error != EINVAL) fail(path, "cannot synchronise to disk");  // EINVAL: not that kind of file
}

void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) fail(to, "cannot replace");
  sync_to_disk(to.has_parent_path() ? to.parent_path() : ".");
}

}  // namespace bagnold::io

#include "io/mercury.hpp"

#include <fmt/format.h>

#include <charconv>

#include "core/error.hpp"

namespace bagnold::io {

namespace {

std::ifstream open(const std::filesystem::path& path) {
  std::ifstream in(path);
  if (!in) throw IoError(fmt::format("{}: cannot be read", path.string()));
  return in;
}

[[noreturn]] void fail(const std::filesystem::path& path, std::int64_t line, const std::string& what) {
  throw InputError(fmt::format("{}:{}:1: error: {}", path.string(), line, what));
}

// The numbers of a line; stops at the first thing that is none.
std::vector<double> numbers_of(const std::string& text) {
  std::vector<double> out;
  const char *at = text.data(), *end = text.data() + text.size();
  while (true) {
    while (at != end && (*at == ' ' || *at == '\t' || *at == '#' || *at == '\r')) ++at;
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc()) return out;
    out.push_back(value);
    at = next;
  }
}

bool is_blank(const std::string& text) { return text.find_first_not_of(" \t\r") == std::string::npos; }

}  // namespace

MercuryData::MercuryData(const std::filesystem::path& path) : path_(path), in_(open(path)) {}

std::optional<MercuryParticles> MercuryData::next() {
  std::string text;
  do {
    if (!std::getline(in_, text)) return std::nullopt;
    ++line_;
  } while (is_blank(text));
  const auto header = numbers_of(text);
  if (header.size() != 8)
    fail(path_, line_,
         fmt::format("{} numbers, expected the header of an instant in three dimensions: N, time, and the six bounds",
                     header.size()));
  MercuryParticles out;
  out.time = header[1];
  out.lo = {header[2], header[3], header[4]};
  out.hi = {header[5], header[6], header[7]};
  const auto n = static_cast<std::size_t>(header[0]);
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::getline(in_, text)) fail(path_, line_, fmt::format("the file ends after {} of {} particles", i, n));
    ++line_;
    const auto q = numbers_of(text);
    if (q.size() != 14)
      fail(
          path_, line_,
          fmt::format("{} numbers, expected 14: position, velocity, radius, angles, angular velocity, info", q.size()));
    out.x.push_back({q[0], q[1], q[2]});
    out.v.push_back({q[3], q[4], q[5]});
    out.radius.push_back(q[6]);
    out.omega.push_back({q[10], q[11], q[12]});
    out.info.push_back(q[13]);
  }
  return out;
}

MercuryFstat::MercuryFstat(const std::filesystem::path& path) : path_(path), in_(open(path)) {}

std::optional<MercuryContacts> MercuryFstat::next() {
  std::string text = std::move(held_);
  held_.clear();
  while (is_blank(text)) {
    if (!std::getline(in_, text)) return std::nullopt;
    ++line_;
  }
  const auto header = numbers_of(text);
  if (text[0] != '#' || header.empty()) fail(path_, line_, "expected '# time ...', the header of an instant");
  MercuryContacts out;
  out.time = header[0];
  int header_lines = 1;
  while (std::getline(in_, text)) {
    ++line_;
    if (is_blank(text)) continue;
    if (text[0] == '#') {
      if (header_lines++ < 3) continue;  // three lines a header
      held_ = text;
      break;
    }
    header_lines = 3;
    const auto q = numbers_of(text);
    if (q.size() != 16)
      fail(path_, line_,
           fmt::format("{} numbers, expected 16: time, i, j, contact point, overlap, tangential overlap, |fn|, |ft|, "
                       "normal, tangent",
                       q.size()));
    MercuryContact c;
    c.i = static_cast<std::int64_t>(q[1]);
    c.j = static_cast<std::int64_t>(q[2]);
    c.overlap = q[6];
    // The file turns normal and tangent of walls round.
    const double turn = c.j < 0 ? -1 : 1;
    c.normal = turn * Vec3{q[10], q[11], q[12]};
    c.force = q[8] * c.normal + (turn * q[9]) * Vec3{q[13], q[14], q[15]};
    out.contacts.push_back(c);
  }
  return out;
}

}  // namespace bagnold::io

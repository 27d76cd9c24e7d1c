#include "io/lammps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "core/error.hpp"

namespace bagnold::io {

namespace {

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::optional<double> number(const std::string& word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<std::size_t> LammpsFrame::find(const std::string& column) const {
  const auto it = std::find(columns.begin(), columns.end(), column);
  return it == columns.end() ? std::nullopt : std::optional(static_cast<std::size_t>(it - columns.begin()));
}

LammpsDump::LammpsDump(const std::filesystem::path& path) : path_(path), in_(path) {
  if (!in_) throw IoError(fmt::format("{}: cannot be read", path.string()));
}

bool LammpsDump::line(std::string& text) {
  if (!std::getline(in_, text)) return false;
  if (!text.empty() && text.back() == '\r') text.pop_back();
  ++line_;
  return true;
}

void LammpsDump::fail(const std::string& what) const {
  throw InputError(fmt::format("{}:{}:1: error: {}", path_.string(), line_, what));
}

void LammpsDump::read_box(const std::string& header, LammpsFrame& frame) {
  const auto words = words_of(header);  // ITEM: BOX BOUNDS pp pp ff
  if (words.size() != 6)
    fail("a box that is not orthogonal is not supported, expected ITEM: BOX BOUNDS with three boundary flags");
  for (int a = 0; a < 3; ++a) {
    frame.periodic[static_cast<std::size_t>(a)] = words[3 + static_cast<std::size_t>(a)] == "pp";
    std::string text;
    if (!line(text)) fail("the file ends within the bounds of the box");
    const auto bounds = words_of(text);
    const auto lo = bounds.empty() ? std::nullopt : number(bounds[0]),
               hi = bounds.size() < 2 ? std::nullopt : number(bounds[1]);
    if (!lo || !hi) fail("expected two numbers, the bounds of the box");
    frame.lo[a] = *lo;
    frame.hi[a] = *hi;
  }
}

void LammpsDump::read_rows(const std::string& header, std::size_t count, LammpsFrame& frame) {
  const auto words = words_of(header);  // ITEM: ATOMS id type ..., ITEM: ENTRIES index c_1[1] ...
  frame.columns.assign(words.begin() + 2, words.end());
  frame.values.reserve(count * frame.columns.size());
  std::string text;
  for (std::size_t row = 0; row < count; ++row) {
    if (!line(text)) fail(fmt::format("the file ends after {} of {} rows", row, count));
    const auto cells = words_of(text);
    if (cells.size() != frame.columns.size())
      fail(fmt::format("{} values, expected {}", cells.size(), frame.columns.size()));
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const auto value = number(cells[c]);
      if (!value) fail(fmt::format("'{}' in column {}, expected a number", cells[c], frame.columns[c]));
      frame.values.push_back(*value);
    }
  }
}

std::optional<LammpsFrame> LammpsDump::next() {
  LammpsFrame frame;
  std::string text;
  std::size_t count = 0;
  const auto integer = [&] {
    if (!line(text)) fail("the file ends within a header");
    const auto value = number(words_of(text).empty() ? "" : words_of(text)[0]);
    if (!value) fail("expected a number");
    return *value;
  };
  while (line(text)) {
    if (text.starts_with("ITEM: TIMESTEP"))
      frame.step = static_cast<std::int64_t>(integer());
    else if (text.starts_with("ITEM: TIME"))
      frame.time = integer();
    else if (text.starts_with("ITEM: NUMBER OF"))
      count = static_cast<std::size_t>(integer());
    else if (text.starts_with("ITEM: BOX BOUNDS"))
      read_box(text, frame);
    else if (text.starts_with("ITEM: UNITS"))
      line(text);
    else if (text.starts_with("ITEM: ATOMS") || text.starts_with("ITEM: ENTRIES")) {
      frame.atoms = text.starts_with("ITEM: ATOMS");
      read_rows(text, count, frame);
      return frame;
    } else if (!words_of(text).empty()) {
      fail("expected a line that begins with ITEM:");
    }
  }
  return std::nullopt;
}

}  // namespace bagnold::io

#include "core/fields.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>

namespace bagnold {

std::string to_string(const Range& range) {
  const bool below = std::isfinite(range.hi), above = std::isfinite(range.lo);
  const std::string lo = fmt::format("{} {:g}", range.lo_open ? ">" : ">=", range.lo);
  const std::string hi = fmt::format("{} {:g}", range.hi_open ? "<" : "<=", range.hi);
  if (above && below) return lo + " and " + hi;
  if (above) return lo;
  if (below) return hi;
  return "any";
}

namespace {
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t change = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({change, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}
}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
  std::string best;
  std::size_t least = std::max<std::size_t>(2, word.size() / 2) + 1;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace bagnold

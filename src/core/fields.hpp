// Self-description. A law or a section of a case is a plain struct with a tuple of fields; that one tuple feeds
// reading, range and unknown-key errors, `bagnold explain`, the docs, file attributes and the fitter.
//
//   struct Coulomb {
//     static constexpr std::string_view name = "coulomb";
//     static constexpr std::string_view summary = "constant friction, mu = tan(delta)";
//     static constexpr std::string_view source = "Weinhart et al. 2012, section 4";
//     double delta_deg = 20;
//     static constexpr auto fields() {
//       return std::tuple{field("delta_deg", "deg", "basal friction angle", &Coulomb::delta_deg, open(0, 90))};
//     }
//   };
#pragma once
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "core/vec3.hpp"

namespace bagnold {

// Where a number may lie. A bound may be excluded.
struct Range {
  double lo = -std::numeric_limits<double>::infinity();
  double hi = std::numeric_limits<double>::infinity();
  bool lo_open = false, hi_open = false;
  constexpr bool contains(double v) const {
    return (lo_open ? v > lo : v >= lo) && (hi_open ? v < hi : v <= hi);  // false for NaN
  }
};
constexpr Range any_number() { return {}; }
constexpr Range positive() { return {.lo = 0, .lo_open = true}; }
constexpr Range non_negative() { return {.lo = 0}; }
constexpr Range closed(double lo, double hi) { return {.lo = lo, .hi = hi}; }
constexpr Range open(double lo, double hi) { return {.lo = lo, .hi = hi, .lo_open = true, .hi_open = true}; }
constexpr Range at_least(double lo) { return {.lo = lo}; }
std::string to_string(const Range& range);  // "> 0", "0 .. 90", "any"

// One member of a self-described struct. The default value of the member in a default-constructed struct is the
// default of the key; `required` keys have none. An std::optional member may be left out or written "auto".
template <class Struct, class Member>
struct Field {
  std::string_view name, unit, meaning;
  Member Struct::*member;
  Range range;
  bool required;
};

template <class S, class M>
constexpr Field<S, M> field(std::string_view name, std::string_view unit, std::string_view meaning, M S::*member,
                            Range range = any_number()) {
  return {name, unit, meaning, member, range, false};
}
template <class S, class M>
constexpr Field<S, M> required(std::string_view name, std::string_view unit, std::string_view meaning, M S::*member,
                               Range range = any_number()) {
  return {name, unit, meaning, member, range, true};
}

// f(field) for every field of T, in order of declaration.
template <class T, class F>
constexpr void for_each_field(F&& f) {
  std::apply([&](const auto&... each) { (f(each), ...); }, T::fields());
}

// The nearest of `known` to `word` by edit distance; empty when nothing is close enough to be a likely misspelling.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

}  // namespace bagnold

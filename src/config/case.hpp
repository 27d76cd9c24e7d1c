// A case file, read. The only reader of TOML: every key is asked for by name, type, unit and range; what is asked
// for is remembered, so unknown keys are errors that name the nearest known one, and the resolved input (every
// default written out) falls out of the reading itself.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/registry.hpp"
#include "core/vec3.hpp"

namespace bagnold::config {

using Value = std::variant<bool, std::int64_t, double, std::string, std::vector<double>, std::vector<std::string>>;

struct Node;      // one TOML value with its place in the file
struct Resolved;  // one table of the resolved output

// A view of one table of the case. Cheap to copy.
class Section {
 public:
  // Throws InputError `file:line:col: error: <what>` at the place of `key` (or of the table when it is absent).
  [[noreturn]] void fail(std::string_view key, const std::string& what) const;
  bool has(std::string_view key) const;  // does not count as asking
  void ask(std::string_view key) const;  // makes `key` known without reading it
  std::string path() const;              // "scenario", "contact.grain-base"

  Section child(std::string_view key) const;              // empty section when absent
  std::vector<Section> list(std::string_view key) const;  // array of tables; empty when absent
  std::vector<std::string> keys() const;                  // as written in the file

  // One value. `fallback` nothing: the key is required. A type mismatch or a number outside `range` is an error.
  template <class T>
  T get(std::string_view key, std::optional<T> fallback, Range range = any_number(), std::string_view unit = "") const;
  // A choice by name among `known`.
  std::string choose(std::string_view key, std::optional<std::string> fallback,
                     const std::vector<std::string>& known) const;
  // A number, or "auto"/absent for nothing.
  std::optional<double> get_auto(std::string_view key, Range range = any_number(), std::string_view unit = "") const;
  // Replaces what the resolved case says of `key` (for example the number behind "auto").
  void resolve(std::string_view key, Value value) const;

  // All fields of a self-described struct. With `inherited`, absent keys keep its values instead of the defaults.
  template <class T>
  T read() const;
  template <class T>
  T read(const T& inherited) const;
  // `key` names a law of the registry; its parameters are keys of this same section.
  template <class R>
  typename R::Any read_law(std::string_view key, std::optional<std::string> fallback) const;

 private:
  friend class Case;
  Section(const Node* node, Resolved* resolved) : node_(node), resolved_(resolved) {}
  const Node* node_;
  Resolved* resolved_;
  template <class M>
  M read_member(std::string_view name, std::string_view unit, const Range& range, bool is_required,
                const M& fallback) const;
};

class Case {
 public:
  // Reads `path` and applies `key.path=value` overrides. Throws InputError (syntax, with line and column), IoError.
  static Case from_file(const std::string& path, const std::vector<std::string>& overrides = {});
  static Case from_text(const std::string& text, const std::string& name,
                        const std::vector<std::string>& overrides = {});
  Case(Case&&) noexcept;
  Case& operator=(Case&&) noexcept;
  Case(const Case&) = delete;
  Case& operator=(const Case&) = delete;
  ~Case();

  Section root() const;
  // Throws InputError at the place of a dotted key ("time.step"), or as near to it as the case goes.
  [[noreturn]] void fail(const std::string& key, const std::string& what) const;
  // Call when everything has been read: throws InputError for the first key nobody asked for.
  void reject_unread() const;
  std::string resolved() const;  // TOML text of every key asked for, defaults included
  // The file that `key` of `section` names, relative to the folder of the case.
  std::string file(const Section& section, std::string_view key) const;
  // Where the resolved case will be kept: there it names files relative to `directory`, so that it can be run from
  // there, and both can be moved together. At first the folder of the case itself.
  void will_live_in(const std::string& directory);

 private:
  Case();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// ---- templates -------------------------------------------------------------------------------------------------

template <class M>
M Section::read_member(std::string_view name, std::string_view unit, const Range& range, bool is_required,
                       const M& fallback) const {
  if constexpr (std::is_same_v<M, std::optional<double>>) {
    return get_auto(name, range, unit);
  } else if constexpr (std::is_same_v<M, Vec3>) {
    const auto v = get<std::vector<double>>(
        name, is_required ? std::nullopt : std::optional(std::vector<double>{fallback.x, fallback.y, fallback.z}),
        range, unit);
    if (v.size() != 3) fail(name, "expected three numbers [x, y, z]");
    return Vec3{v[0], v[1], v[2]};
  } else if constexpr (std::is_integral_v<M> && !std::is_same_v<M, bool>) {
    return static_cast<M>(get<std::int64_t>(
        name, is_required ? std::nullopt : std::optional(static_cast<std::int64_t>(fallback)), range, unit));
  } else {
    return get<M>(name, is_required ? std::nullopt : std::optional(fallback), range, unit);
  }
}

template <class T>
T Section::read() const {
  T t{};
  for_each_field<T>(
      [&](const auto& f) { t.*(f.member) = read_member(f.name, f.unit, f.range, f.required, t.*(f.member)); });
  return t;
}

template <class T>
T Section::read(const T& inherited) const {
  T t = inherited;
  for_each_field<T>([&](const auto& f) {
    if (has(f.name))
      t.*(f.member) = read_member(f.name, f.unit, f.range, false, t.*(f.member));
    else
      ask(f.name);
  });
  return t;
}

template <class R>
typename R::Any Section::read_law(std::string_view key, std::optional<std::string> fallback) const {
  auto any = *R::make(choose(key, std::move(fallback), R::names()));
  std::visit([&](auto& law) { law = read<std::decay_t<decltype(law)>>(); }, any);
  return any;
}

}  // namespace bagnold::config

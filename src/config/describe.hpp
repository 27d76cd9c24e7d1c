// Turns self-described structs and registries into text: `bagnold explain` and the docs print what the reader reads.
#pragma once
#include <fmt/format.h>

#include <string>

#include "core/fields.hpp"
#include "core/registry.hpp"

namespace bagnold::config {

template <class M>
std::string default_text(const M& value) {
  if constexpr (std::is_same_v<M, std::optional<double>>)
    return value ? fmt::format("{:g}", *value) : "auto";
  else if constexpr (std::is_same_v<M, bool>)
    return value ? "true" : "false";
  else if constexpr (std::is_same_v<M, Vec3>)
    return fmt::format("[{:g}, {:g}, {:g}]", value.x, value.y, value.z);
  else if constexpr (std::is_arithmetic_v<M>)
    return fmt::format("{:g}", static_cast<double>(value));
  else if constexpr (std::is_convertible_v<M, std::string>)
    return value.empty() ? "none" : std::string(value);
  else
    return fmt::format("{} values", value.size());
}

// One line per key: name, default, unit, range, meaning.
template <class T>
std::string describe_fields() {
  std::string out;
  const T defaults{};
  for_each_field<T>([&](const auto& f) {
    const std::string value = f.required ? "required" : "default " + default_text(defaults.*(f.member));
    const std::string range = to_string(f.range);
    out += fmt::format("    {:<24} {:<20} {}{}{}\n", f.name, value, f.meaning,
                       f.unit.empty() ? "" : fmt::format(" [{}]", f.unit), range == "any" ? "" : ", " + range);
  });
  return out;
}

// A law or section: heading, source, keys. `name`, `summary` and `source` are static members of T.
template <class T>
std::string describe() {
  std::string out = fmt::format("{}: {}\n", T::name, T::summary);
  if constexpr (requires { T::equation; }) out += fmt::format("    {}\n", T::equation);
  if constexpr (requires { T::source; }) out += fmt::format("    source: {}\n", T::source);
  return out + describe_fields<T>();
}

}  // namespace bagnold::config

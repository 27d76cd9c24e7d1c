// No resistance to rolling.
#pragma once
#include <string_view>
#include <tuple>
#include <variant>

#include "laws/contact/response.hpp"

namespace bagnold::laws {

template <class N>
struct NoRolling {
  static constexpr bool active = false;
};

struct NoRollingResistance {
  static constexpr std::string_view name = "none";
  static constexpr std::string_view summary = "no resistance to rolling";
  static constexpr std::string_view source = "";
  static constexpr auto fields() { return std::tuple{}; }
  using Constants = std::variant<NoRolling<double>>;
  Constants constants(const NominalPair&) const { return NoRolling<double>{}; }
};

}  // namespace bagnold::laws

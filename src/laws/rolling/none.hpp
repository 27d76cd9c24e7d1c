// No resistance to rolling.
#pragma once
#include <string_view>
#include <tuple>

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
  NoRolling<double> constants() const { return {}; }
};

}  // namespace bagnold::laws

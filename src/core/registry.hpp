// A registry is a list of types: `using ContactLaws = Registry<Linear, Hertz>;` is the only line a new law adds.
// Its value type `Any` is a variant, so a choice is made once, outside the loops, by std::visit.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace bagnold {

template <class... Laws>
struct Registry {
  using Any = std::variant<Laws...>;

  static std::vector<std::string> names() { return {std::string(Laws::name)...}; }

  // The default-constructed law of that name; nothing if there is none.
  static std::optional<Any> make(std::string_view name) {
    std::optional<Any> law;
    ((Laws::name == name ? void(law = Any(Laws{})) : void()), ...);
    return law;
  }

  // f(law) for a default-constructed law of every type: typed tests, `explain` and the docs go through this.
  template <class F>
  static void for_each(F&& f) {
    (f(Laws{}), ...);
  }
};

inline std::string_view name_of(const auto& any) {
  return std::visit([](const auto& law) { return std::decay_t<decltype(law)>::name; }, any);
}

}  // namespace bagnold

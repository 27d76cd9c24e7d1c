// Shape of the yield surface in the deviatoric plane.
#pragma once
#include <string_view>

#include "core/fields.hpp"

namespace bagnold::laws::yield_surface {

// |tau|/p the same at every Lode angle: the mu(i) law as it is written.
struct DruckerPrager {
  static constexpr std::string_view name = "drucker_prager";
  static constexpr std::string_view summary = "circle: friction does not depend on the Lode angle";
  static constexpr std::string_view source = "Drucker & Prager 1952; Jop et al. 2006";
  static constexpr auto fields() { return std::tuple<>{}; }
  struct Shape {
    static constexpr bool circular = true;
    double operator()(double) const { return 1; }
  };
  static constexpr double largest_friction = 1e300;
  static Shape shape(double) { return {}; }
};

}  // namespace bagnold::laws::yield_surface

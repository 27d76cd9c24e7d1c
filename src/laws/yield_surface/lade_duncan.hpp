// Shape of the yield surface in the deviatoric plane.
#pragma once
#include <string_view>

#include "core/fields.hpp"
#include "laws/yield_surface/smooth_cone.hpp"

namespace bagnold::laws::yield_surface {

// I1^3/I3 = const, the value of plane strain.                               Lade & Duncan 1975
// m^2 - mu^2 = (2/sqrt 27) cos(3 theta) m^3 in the notation of Matsuoka & Nakai's law, a smooth cone with c = mu.
struct LadeDuncan {
  static constexpr std::string_view name = "lade_duncan";
  static constexpr std::string_view summary = "I1^3/I3 = const: as Matsuoka & Nakai's, nearer to a circle";
  static constexpr std::string_view source = "Lade & Duncan 1975, J. Geotech. Eng. Div. 101, 1037-1053";
  static constexpr auto fields() { return std::tuple<>{}; }
  using Shape = SmoothCone;
  static constexpr double largest_friction = 1;
  // mu: friction in plane strain, < 1.
  static Shape shape(double mu) { return {mu}; }
};

}  // namespace bagnold::laws::yield_surface

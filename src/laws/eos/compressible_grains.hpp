// Pressure of weakly compressible grains.
#pragma once
#include <cmath>
#include <string_view>

#include "core/fields.hpp"
#include "laws/eos/cubic.hpp"

namespace bagnold::laws::eos {

// p = (rho_s/rho_s0 - 1)/Kt, d/d0 = (rho_s0/rho_s)^(1/D)                   Minatti & Paris 2015, eqs 41, 43
// The unknown is y = sqrt(rho_s* - 1) >= 0, so p = y^2/Kt is never negative: grains do not stick.
struct CompressibleGrains {
  static constexpr std::string_view name = "minatti2015";
  static constexpr std::string_view summary = "p = (rho_s/rho_s0 - 1)/Kt, bulk density through phi(i): the cubic (44)";
  static constexpr std::string_view source = "Minatti & Paris 2015, eqs 40-44";
  double grain_density = 2600, compressibility = 4.1e-5;
  static constexpr auto fields() {
    using S = CompressibleGrains;
    return std::tuple{
        field("grain_density", "kg/m^3", "rho_s0, density of the grains under no load", &S::grain_density, positive()),
        field("compressibility", "1/Pa", "Kt of the grains", &S::compressibility, positive())};
  }
  // i = shear/y with shear = gamma d0 sqrt(Kt rho_s0).
  double shear_scale(double d0) const { return d0 * std::sqrt(compressibility * grain_density); }
  double sound_speed(double phi_max) const { return 1 / std::sqrt(compressibility * phi_max * grain_density); }
  template <class T>
  T pressure(T y) const {
    return y * y / compressibility;
  }
};

}  // namespace bagnold::laws::eos

// A column of continuum released on a flat base.
#pragma once
#include <cstdint>
#include <string_view>

#include "sph/model.hpp"
#include "sph/state.hpp"

namespace bagnold::scenario {

enum class ColumnGeometry { planar, axisymmetric, cylinder };  // full width; r-z; 3D

struct ContinuumColumn {
  static constexpr std::string_view name = "column";
  static constexpr std::string_view summary =
      "column of continuum released on a flat base; geometry = planar, axisymmetric or cylinder (3D)";
  static constexpr std::string_view source = "Minatti & Paris 2015, section 5.2; Lube et al. 2004";
  double radius = 0.0972, height = 0.0875, spacing = 3.02e-3, slope_deg = 0, disorder = 0;
  static constexpr auto fields() {
    using S = ContinuumColumn;
    return std::tuple{field("radius", "m", "r0, half the width of a planar column", &S::radius, positive()),
                      field("height", "m", "H0", &S::height, positive()),
                      field("spacing", "m", "dp, distance of particles", &S::spacing, positive()),
                      field("slope_deg", "deg", "heap with its apex at H0 and sides of this angle; 0: upright column",
                            &S::slope_deg, closed(0, 80)),
                      field("disorder", "", "largest displacement of a particle at the start along an axis, over dp",
                            &S::disorder, closed(0, 0.25))};
  }
};

void set_geometry(const ContinuumColumn& column, ColumnGeometry geometry, sph::Model& model);
// A lattice at rest, density in hydrostatic equilibrium with what is above. Its distances are dp stretched so that whole rows
// fill r0 and H0; `seed` decides the disorder.
sph::Particles make_particles(const ContinuumColumn& column, ColumnGeometry geometry, const sph::Model& model,
                              std::uint64_t seed = 1);

// (r1 - r0)/r0 of the experiments: 1.24 a, 1.6 a^1/2 axisymmetric (Lube et al. 2004); 1.2 a, 1.9 a^2/3 planar (2005).
double measured_runout(double aspect_ratio, ColumnGeometry geometry);

}  // namespace bagnold::scenario

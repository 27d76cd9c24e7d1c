// How fast the printed equations flow down a plane: what their operators return of a uniform shear, and the flow that follows.
#pragma once
#include "scenario/inclined_plane.hpp"
#include "sph/work.hpp"

namespace bagnold::scenario {

// Away from base and surface, on the particles as they lie: stress over eta du/dz; shear rate over du/dz, which is also
// force over the gradient of p. NaN when the layer is too thin to have an inside.
struct OperatorResponse {
  double stress = 0, gradient = 0;
};
OperatorResponse printed_response(const InclinedPlane& plane, const sph::State& state, const sph::Work& work,
                                  const sph::Model& model);

// With stress a eta u', shear rate b u' and pressure gradient b p', particles flow as if friction were a/b^2 mu(i b^(3/2));
// artificial viscosity adds a alpha h c rho/8. Mean velocity at `time` of the one-dimensional momentum equation with that.
// Needs the mu(i) law.
double responding_velocity(const InclinedPlane& plane, const sph::Model& model, const OperatorResponse& response,
                           double time);

}  // namespace bagnold::scenario

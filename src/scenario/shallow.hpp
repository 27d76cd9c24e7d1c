// Initial states and beds of the shallow-layer model.
#pragma once
#include <functional>
#include <string_view>
#include <tuple>

#include "core/fields.hpp"
#include "shallow/solver.hpp"

namespace bagnold::scenario {

// A plane inclined by angle_deg; x runs along the grid, downslope at direction_deg from it.
struct Incline {
  static constexpr std::string_view name = "incline";
  static constexpr std::string_view summary =
      "an inclined plane in its own coordinates: x along it, thickness normal to it";
  double angle_deg = 0, direction_deg = 0, gravity = 1, length = 0, width = 0, x0 = 0, y0 = 0;
  int cells = 0, cells_across = 1;
  static constexpr auto fields() {
    using S = Incline;
    return std::tuple{
        required("angle_deg", "deg", "inclination of the plane", &S::angle_deg,
                 Range{.lo = 0, .hi = 90, .hi_open = true}),
        field("direction_deg", "deg", "downslope direction, from x towards y", &S::direction_deg),
        field("gravity", "length/time^2", "acceleration of gravity", &S::gravity, positive()),
        required("length", "length", "length along x", &S::length, positive()),
        field("width", "length", "length along y (two dimensions)", &S::width, non_negative()),
        field("x0", "length", "where x starts", &S::x0),
        field("y0", "length", "where y starts", &S::y0),
        required("cells", "1", "cells along x", &S::cells, at_least(3)),
        field("cells_across", "1", "cells along y; 1 is the one-dimensional model", &S::cells_across, at_least(1))};
  }
};

// A straight chute that turns, along an arc, into a flat run-out: a surface z(x), x horizontal.
struct RunOut {
  static constexpr std::string_view name = "run-out";
  static constexpr std::string_view summary =
      "a chute that bends into a run-out, in horizontal coordinates with the metric of the slope";
  double angle_deg = 0, runout_angle_deg = 0, gravity = 1, length = 0, width = 0, bend_at = 0, bend_length = 0,
         channel_depth = 0;
  int cells = 0, cells_across = 1;
  static constexpr auto fields() {
    using S = RunOut;
    const Range angle{.lo = 0, .hi = 90, .hi_open = true};
    return std::tuple{
        required("angle_deg", "deg", "inclination of the chute", &S::angle_deg, angle),
        field("runout_angle_deg", "deg", "inclination of the run-out", &S::runout_angle_deg, angle),
        field("gravity", "length/time^2", "acceleration of gravity", &S::gravity, positive()),
        required("length", "length", "horizontal length", &S::length, positive()),
        field("width", "length", "width (two dimensions), centred on y = 0", &S::width, non_negative()),
        required("bend_at", "length", "x where the bend starts", &S::bend_at, positive()),
        required("bend_length", "length", "horizontal length of the bend", &S::bend_length, positive()),
        field("channel_depth", "length", "rise of the chute's sides above its middle", &S::channel_depth,
              non_negative()),
        required("cells", "1", "cells along x", &S::cells, at_least(3)),
        field("cells_across", "1", "cells along y; 1 is the one-dimensional model", &S::cells_across, at_least(1))};
  }
};

void set_up(const Incline& incline, shallow::Definition& d);
void set_up(const RunOut& runout, shallow::Definition& d);  // needs the boundaries of `d` only

// A release: thickness and velocity along x, with an optional perturbation of the thickness.
struct Release {
  static constexpr std::string_view name = "release";
  static constexpr std::string_view summary = "what lies on the plane at the start";
  double thickness = 0, velocity = 0, from = -1e300, to = 1e300, centre_x = 0, centre_y = 0, radius = 1;
  double perturbation = 0, wavelength = 1;
  static constexpr auto fields() {
    using S = Release;
    return std::tuple{
        field("thickness", "length", "largest thickness, normal to the bed", &S::thickness, non_negative()),
        field("velocity", "length/time", "velocity along x", &S::velocity),
        field("from", "length", "slab: lower end in x", &S::from),
        field("to", "length", "slab: upper end in x", &S::to),
        field("centre_x", "length", "cap: centre", &S::centre_x),
        field("centre_y", "length", "cap: centre", &S::centre_y),
        field("radius", "length", "cap: radius of its base", &S::radius, positive()),
        field("perturbation", "1", "slab: relative amplitude of a sine in x", &S::perturbation, closed(0, 0.9)),
        field("wavelength", "length", "slab: wavelength of the perturbation", &S::wavelength, positive())};
  }
};
void fill_slab(const Release& r, const shallow::Solver& solver, shallow::State& state);
void fill_cap(const Release& r, const shallow::Solver& solver, shallow::State& state);

}  // namespace bagnold::scenario

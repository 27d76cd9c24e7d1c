// The part of a case that belongs to the continuum model.
#pragma once
#include <cstdint>
#include <string>

#include "config/case.hpp"
#include "scenario/continuum_column.hpp"
#include "scenario/inclined_plane.hpp"
#include "sph/algorithm.hpp"

namespace bagnold::app {

struct SphInput {
  std::string scenario;  // "inclined_plane" or "column"
  scenario::InclinedPlane plane;
  scenario::ContinuumColumn column;
  scenario::ColumnGeometry geometry = scenario::ColumnGeometry::planar;
  sph::Model model;
  std::uint64_t seed = 1;
  double end = 0;
  bool energy_ledger = false, stop_when_arrested = false;
};
SphInput read_sph(config::Case& input);

}  // namespace bagnold::app

// What a shallow-layer run has seen so far, cell by cell: extremes, arrival, use of the closure outside its range.
#pragma once
#include <filesystem>
#include <vector>

#include "app/shallow_input.hpp"
#include "core/arrays.hpp"
#include "io/columns.hpp"
#include "io/hdf5.hpp"

namespace bagnold::app {

struct ShallowMaps {
  std::vector<double> max_h, max_speed, max_pressure;  // pressure: rho u^2 (stagnation), mass/(length time^2)
  std::vector<double> arrival;                         // first time thicker than impact_depth; NaN: never
  std::vector<double> outside;                         // 1 where moving material left the range of the closure
  double smallest_h = 0, largest_h = 0;                // over cells and time
  // Present values, refreshed by look(); not part of the state.
  std::vector<double> h, u, v;
};

void start_maps(const ShallowInput& in, ShallowMaps& maps);
// After every step: extremes, arrival, validity, over the cells that can be wet.
void observe(const ShallowInput& in, ShallowMaps& maps);
// Before anything below is called: present thickness and velocity.
void look(const ShallowInput& in, ShallowMaps& maps);
std::vector<NamedArray> map_arrays(ShallowMaps& maps);

std::vector<io::Column> shallow_series_columns(const ShallowInput& in);
std::vector<double> shallow_series_row(const ShallowInput& in, const ShallowMaps& maps, double initial_mass);
void write_shallow_snapshot(io::H5File& file, const std::string& group, const ShallowInput& in,
                            const ShallowMaps& maps);
void write_shallow_vti(const std::filesystem::path& path, const ShallowInput& in, const ShallowMaps& maps);
// final.csv (one dimension), maps.vti, and GeoTIFFs in the coordinate system of the terrain.
void write_shallow_results(const std::filesystem::path& directory, const ShallowInput& in, const ShallowMaps& maps);

}  // namespace bagnold::app

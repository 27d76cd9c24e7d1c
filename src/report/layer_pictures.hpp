// Pictures of layers: profiles in time and x-t diagrams in one dimension, maps over a shaded relief in two.
#pragma once
#include <array>
#include <vector>

#include "io/csv.hpp"
#include "report/layers.hpp"
#include "report/picture.hpp"

namespace bagnold::report {

// A run with a layer in it.
struct LayerRun {
  std::string name;
  const LayerFile* layers = nullptr;
  const io::CsvTable* series = nullptr;  // may be missing
};

// The pictures of each run; names end in "_<run>" when there are several. Throws IoError when a snapshot lacks what it
// must hold.
std::vector<Picture> layer_pictures(const std::vector<LayerRun>& runs);

// Several one-dimensional runs on one grid, the coarsest of theirs, at the times at which the first has snapshots and all
// run. Masses per area are averages over the cells; where a run has no cells it has no mass.
struct Comparison {
  std::vector<std::string> names;
  std::vector<double> t, x;
  // [run][time][cell]: mass per area and its mean velocity, NaN without mass
  std::vector<std::vector<std::vector<double>>> mass, u;
  // [run][share][time]: x below which that share of the mass lies
  static constexpr std::array<double, 4> shares{0.01, 0.5, 0.9, 0.99};
  std::vector<std::array<std::vector<double>, 4>> where;
};
Comparison compare(const std::vector<LayerRun>& runs);
// Columns t, x, then mass and u of each run.
void write_comparison(const std::filesystem::path& file, const Comparison& c);

// ---- parts, in layer_profiles.cpp, layer_maps.cpp and layer_compared.cpp ----------------------------------------------
std::vector<Picture> profile_pictures(const LayerRun& run);  // one dimension
std::vector<Picture> map_pictures(const LayerRun& run);      // two dimensions
Picture compared_picture(const Comparison& c);

// Snapshots to draw: the first, the last, and others evenly between, `most` at most.
std::vector<std::size_t> chosen(std::size_t snapshots, std::size_t most);

}  // namespace bagnold::report

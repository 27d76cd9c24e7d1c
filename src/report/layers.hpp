// A layer of grains on its bed as run.h5 holds it: the snapshots of the shallow-layer model, or those of an avalanche
// of the particle model averaged across the slope.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/hdf5.hpp"

namespace bagnold::report {

// Cells row by row, x fastest. One row: one dimension.
struct LayerGrid {
  std::size_t nx = 0, ny = 0;
  double x0 = 0, y0 = 0, dx = 1, dy = 1;
  std::vector<double> bed;  // elevation
  double x(std::size_t i) const { return x0 + (static_cast<double>(i) + 0.5) * dx; }
  double y(std::size_t j) const { return y0 + (static_cast<double>(j) + 0.5) * dy; }
  bool two_d() const { return ny > 1; }
};

struct Layer {
  double t = 0;
  std::vector<double> mass;  // per area of the bed
  std::vector<double> h;     // thickness; NaN for grains, whose layer has no sharp surface
  std::vector<double> u, v;  // mean velocity over the depth
};

// Largest values up to the last snapshot. Two dimensions only.
struct LayerExtremes {
  std::vector<double> max_h, max_speed, arrival;  // arrival: time, NaN where nothing came
};

// The snapshots of a run, read one by one.
class LayerFile {
 public:
  // Nothing when the run is of another kind. Throws IoError for a run.h5 that lacks what the kind of run promises.
  static std::optional<LayerFile> open(const std::filesystem::path& run, const std::string& model,
                                       const std::string& scenario);
  bool of_grains() const { return of_grains_; }
  const LayerGrid& grid() const { return grid_; }
  const std::vector<double>& times() const { return times_; }
  Layer read(std::size_t snapshot) const;
  LayerExtremes extremes() const;

 private:
  explicit LayerFile(io::H5File file) : file_(std::move(file)) {}
  Layer bin_grains(const std::string& group) const;
  std::vector<double> field(std::size_t snapshot, const char* name) const;
  io::H5File file_;
  bool of_grains_ = false;
  LayerGrid grid_;
  std::vector<std::string> groups_;
  std::vector<double> times_;
};

}  // namespace bagnold::report

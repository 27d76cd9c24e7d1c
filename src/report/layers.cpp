#include "report/layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/box.hpp"
#include "core/error.hpp"

namespace bagnold::report {

namespace {

constexpr double bin_in_diameters = 2;

// Bins along x over the periodic box of the first snapshot.
LayerGrid bins(const io::H5File& file, const std::string& group) {
  const auto box = file.read<double>(group + "/grains/box");  // origin, length, periodic
  const auto diameter = file.read<double>(group + "/grains/diameter");
  LayerGrid grid;
  grid.nx = static_cast<std::size_t>(std::max(1.0, std::round(box.at(3) / (bin_in_diameters * diameter.at(0)))));
  grid.ny = 1;
  grid.x0 = box[0];
  grid.y0 = box[1];
  grid.dx = box[3] / static_cast<double>(grid.nx);
  grid.dy = box[4];
  grid.bed.assign(grid.nx, 0.0);
  return grid;
}

}  // namespace

std::optional<LayerFile> LayerFile::open(const std::filesystem::path& run, const std::string& model,
                                         const std::string& scenario) {
  const bool grains = model == "dem" && scenario == "avalanche";
  if (model != "shallow" && !grains) return std::nullopt;
  LayerFile layers(io::H5File::read_only(run / "run.h5"));
  const io::H5File& file = layers.file_;
  layers.of_grains_ = grains;
  if (!file.exists("snapshots") || file.children("snapshots").empty())
    throw IoError(fmt::format("{}: error: no snapshots, expected at least one", (run / "run.h5").string()));
  for (const auto& name : file.children("snapshots")) {
    layers.groups_.push_back("snapshots/" + name);
    layers.times_.push_back(file.double_attribute(layers.groups_.back(), "t"));
  }
  if (grains) {
    layers.grid_ = bins(file, layers.groups_[0]);
    return layers;
  }
  LayerGrid& grid = layers.grid_;
  const auto corner = file.read<double>("grid/x0_y0_dx_dy");
  const auto dims = file.dims("grid/bed");
  if (corner.size() != 4 || dims.size() != 2)
    throw IoError(fmt::format("{}: error: grid/ is not that of a shallow-layer run", (run / "run.h5").string()));
  grid = {.nx = dims[1], .ny = dims[0], .x0 = corner[0], .y0 = corner[1], .dx = corner[2], .dy = corner[3], .bed = {}};
  grid.bed = file.read<double>("grid/bed");
  return layers;
}

std::vector<double> LayerFile::field(std::size_t snapshot, const char* name) const {
  const std::string dataset = groups_.at(snapshot) + "/" + name;
  auto values = file_.read<double>(dataset);
  if (values.size() != grid_.nx * grid_.ny)
    throw IoError(fmt::format("{}: error: {} has {} cells, expected {}", file_.path().string(), dataset, values.size(),
                              grid_.nx * grid_.ny));
  return values;
}

// Mass and mean velocity of the grains by where their centres are.
Layer LayerFile::bin_grains(const std::string& group) const {
  const std::string grains = group + "/grains/";
  const auto x = file_.read<Vec3>(grains + "x"), v = file_.read<Vec3>(grains + "v");
  const auto mass = file_.read<double>(grains + "mass");
  const auto flowing = static_cast<std::size_t>(file_.int_attribute(group + "/grains", "flowing"));
  const double length = grid_.dx * static_cast<double>(grid_.nx), area = grid_.dx * grid_.dy;
  const Box box{{grid_.x0, 0, 0}, {length, 1, 1}, {true, false, false}};
  Layer layer;
  layer.mass.assign(grid_.nx, 0.0);
  layer.u.assign(grid_.nx, 0.0);
  for (std::size_t k = 0; k < flowing; ++k) {
    const auto i = std::min(grid_.nx - 1, static_cast<std::size_t>((wrap(box, x[k]).x - grid_.x0) / grid_.dx));
    layer.mass[i] += mass[k];
    layer.u[i] += mass[k] * v[k].x;
  }
  for (std::size_t i = 0; i < grid_.nx; ++i) {
    if (layer.mass[i] > 0) layer.u[i] /= layer.mass[i];
    layer.mass[i] /= area;
  }
  layer.h.assign(grid_.nx, std::numeric_limits<double>::quiet_NaN());
  layer.v.assign(grid_.nx, 0.0);
  return layer;
}

Layer LayerFile::read(std::size_t snapshot) const {
  Layer layer = of_grains_ ? bin_grains(groups_.at(snapshot))
                           : Layer{.mass = field(snapshot, "mass"),
                                   .h = field(snapshot, "h"),
                                   .u = field(snapshot, "u"),
                                   .v = field(snapshot, "v")};
  layer.t = times_.at(snapshot);
  return layer;
}

LayerExtremes LayerFile::extremes() const {
  const std::size_t last = groups_.size() - 1;
  return {field(last, "max_h"), field(last, "max_speed"), field(last, "arrival")};
}

}  // namespace bagnold::report

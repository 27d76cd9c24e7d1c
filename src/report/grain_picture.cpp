#include "report/grain_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/box.hpp"
#include "io/gnuplot.hpp"
#include "io/hdf5.hpp"

namespace bagnold::report {

namespace {

struct Disc {
  double x, z, radius, speed;
};

struct FrontLayer {
  std::vector<Disc> fixed, flowing;  // back to front
  double x_min = 1e300, x_max = -1e300, z_min = 1e300, z_max = -1e300;
};

// The grains within two diameters of the front, y smallest first seen.
FrontLayer front_layer(const io::H5File& file, const std::string& grains) {
  auto x = file.read<Vec3>(grains + "/x");
  const auto v = file.read<Vec3>(grains + "/v");
  const auto diameter = file.read<double>(grains + "/diameter");
  const auto flowing = static_cast<std::size_t>(file.int_attribute(grains, "flowing"));
  const auto b = file.read<double>(grains + "/box");  // origin, length, periodic (0 or 1)
  const Box box{{b.at(0), b.at(1), b.at(2)}, {b.at(3), b.at(4), b.at(5)}, {b.at(6) != 0, b.at(7) != 0, b.at(8) != 0}};
  for (Vec3& r : x) r = wrap(box, r);

  double front = 1e300;
  for (std::size_t i = 0; i < flowing; ++i) front = std::min(front, x[i].y);
  if (!box.periodic[1]) {  // a pile: cut it through the middle
    front = 0;
    for (std::size_t i = 0; i < flowing; ++i) front += x[i].y / static_cast<double>(flowing);
  }
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t left, std::size_t right) { return x[left].y > x[right].y; });
  FrontLayer layer;
  for (const std::size_t i : order) {
    const double depth = x[i].y - front, r = 0.5 * diameter[i];
    if (depth < 0 || depth > 4 * r) continue;
    (i < flowing ? layer.flowing : layer.fixed).push_back({x[i].x, x[i].z, r, norm(v[i])});
    layer.x_min = std::min(layer.x_min, x[i].x - r);
    layer.x_max = std::max(layer.x_max, x[i].x + r);
    layer.z_min = std::min(layer.z_min, x[i].z - r);
    layer.z_max = std::max(layer.z_max, x[i].z + r);
  }
  return layer;
}

// The group of the grains of the last snapshot; empty when there is none.
std::string last_grains(const io::H5File& states) {
  if (!states.exists("snapshots")) return {};
  const auto names = states.children("snapshots");
  if (names.empty() || !states.exists("snapshots/" + names.back() + "/grains")) return {};
  return "snapshots/" + names.back() + "/grains";
}

io::PlotData columns(const std::string& name, const std::vector<Disc>& discs) {
  io::PlotData data{name, {{}, {}, {}, {}}};
  for (const Disc& d : discs) {
    const double row[] = {d.x, d.z, d.radius, d.speed};
    for (std::size_t k = 0; k < 4; ++k) data.columns[k].push_back(row[k]);
  }
  return data;
}

}  // namespace

bool has_grains(const std::filesystem::path& run) {
  if (!std::filesystem::exists(run / "run.h5")) return false;
  const auto states = io::H5File::read_only(run / "run.h5");
  const auto grains = last_grains(states);
  return !grains.empty() && states.int_attribute(grains, "flowing") > 0;
}

void draw_grains(const std::filesystem::path& run, const std::filesystem::path& file) {
  const auto states = io::H5File::read_only(run / "run.h5");
  const FrontLayer layer = front_layer(states, last_grains(states));

  std::string script = fmt::format(
      "set size ratio -1\nset xrange [{}:{}]\nset yrange [{}:{}]\nset xlabel 'x'\nset ylabel 'z'\nset border 3\nset "
      "tics nomirror out\n"
      "set palette defined (0 '#3b4cc0', 0.5 '#dddddd', 1 '#b40426')\nset cblabel 'speed'\nset style fill solid 1 "
      "border lc rgb '#222222'\nunset key\nplot ",
      layer.x_min, layer.x_max, layer.z_min, layer.z_max);
  std::vector<io::PlotData> data{columns("flowing", layer.flowing)};
  if (!layer.fixed.empty()) {
    data.push_back(columns("fixed", layer.fixed));
    script += "$fixed using 1:2:3 with circles lc rgb '#999999', ";
  }
  script += "$flowing using 1:2:3:4 with circles lc palette";
  const double aspect = (layer.z_max - layer.z_min) / (layer.x_max - layer.x_min);
  io::plot(file, script, data, {.width = 720, .height = std::clamp(static_cast<int>(600 * aspect) + 70, 160, 900)});
}

}  // namespace bagnold::report

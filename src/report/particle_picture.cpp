#include "report/particle_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "io/gnuplot.hpp"
#include "io/hdf5.hpp"

namespace bagnold::report {
namespace {

constexpr std::size_t most_panels = 6;

struct Snapshot {
  double t = 0, spacing = 0;
  std::vector<Vec3> x, v;  // of the slice that is drawn
};

struct Extent {
  double left = 1e300, right = -1e300, bottom = 1e300, top = -1e300;
  void include(const Snapshot& s) {
    for (const Vec3& x : s.x) {
      left = std::min(left, x.x - 0.5 * s.spacing), right = std::max(right, x.x + 0.5 * s.spacing);
      bottom = std::min(bottom, x.z - 0.5 * s.spacing), top = std::max(top, x.z + 0.5 * s.spacing);
    }
  }
};

Snapshot read_snapshot(const io::H5File& file, const std::string& group) {
  Snapshot s{
      .t = file.double_attribute(group, "t"), .spacing = file.double_attribute(group, "spacing"), .x = {}, .v = {}};
  const auto x = file.read<Vec3>(group + "/x"), v = file.read<Vec3>(group + "/v");
  for (std::size_t i = 0; i < x.size(); ++i)
    if (std::abs(x[i].y) <= s.spacing) s.x.push_back(x[i]), s.v.push_back(v[i]);
  return s;
}

double reach(const Snapshot& s) {
  double most = 0;
  for (const Vec3& x : s.x) most = std::max(most, std::abs(x.x));
  return most;
}

// First and last, and between them the first to pass each of equal steps of the reach.
std::vector<std::size_t> equal_steps(const std::vector<double>& reaches) {
  std::vector<std::size_t> chosen{0};
  const double step = (reaches.back() - reaches.front()) / static_cast<double>(most_panels - 1);
  for (std::size_t k = 1; k + 1 < reaches.size() && step > 0; ++k)
    if (reaches[k] >= reaches.front() + static_cast<double>(chosen.size()) * step && chosen.size() < most_panels - 1)
      chosen.push_back(k);
  if (reaches.size() > 1) chosen.push_back(reaches.size() - 1);
  return chosen;
}

io::PlotData columns(const std::string& name, const Snapshot& s) {
  io::PlotData data{name, {{}, {}, {}, {}}};
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const double row[] = {1e3 * s.x[i].x, 1e3 * s.x[i].z, 500 * s.spacing, norm(s.v[i])};
    for (std::size_t k = 0; k < 4; ++k) data.columns[k].push_back(row[k]);
  }
  return data;
}

}  // namespace

bool has_particles(const std::filesystem::path& run) {
  if (!std::filesystem::exists(run / "run.h5")) return false;
  const auto states = io::H5File::read_only(run / "run.h5");
  if (!states.exists("snapshots")) return false;
  const auto names = states.children("snapshots");
  return !names.empty() && states.has_attribute("snapshots/" + names.back(), "spacing");
}

void draw_particles(const std::filesystem::path& run, const std::filesystem::path& file) {
  const auto states = io::H5File::read_only(run / "run.h5");
  const auto names = states.children("snapshots");
  std::vector<Snapshot> all;
  std::vector<double> reaches;
  for (const auto& name : names) {
    all.push_back(read_snapshot(states, "snapshots/" + name));
    reaches.push_back(reach(all.back()));
  }
  Extent first, whole;
  first.include(all.front());
  const bool column = reaches.back() > reaches.front() + all.front().spacing;
  const auto chosen = column ? equal_steps(reaches) : std::vector<std::size_t>{all.size() - 1};
  double fastest = 0;
  for (const std::size_t k : chosen) {
    whole.include(all[k]);
    for (const Vec3& v : all[k].v) fastest = std::max(fastest, norm(v));
  }

  const std::size_t across = chosen.size() > 1 ? 2 : 1, down = (chosen.size() + across - 1) / across;
  std::string script = fmt::format(
      "set size ratio -1\nset xrange [{}:{}]\nset yrange [{}:{}]\nset cbrange [0:{}]\nset xlabel 'mm' offset 0,0.5\n"
      "set border 3\nset tics nomirror out\nset palette defined (0 '#3b4cc0', 0.25 '#7b9ff9', 0.5 '#dddddd', 0.75 "
      "'#f08a6c', 1 '#b40426')\nset cblabel 'speed, m/s'\nset style fill solid 1 noborder\nunset key\n",
      1e3 * whole.left, 1e3 * whole.right, 1e3 * std::min(0.0, whole.bottom), 1e3 * whole.top,
      fastest > 0 ? fastest : 1.0);
  if (column)
    script += fmt::format(
        "set arrow from {0},{2} to {0},{3} nohead front\nset arrow from {0},{3} to {1},{3} nohead front\nset arrow "
        "from {1},{3} to {1},{2} nohead front\n",
        1e3 * first.left, 1e3 * first.right, 0.0, 1e3 * first.top);
  if (chosen.size() > 1) script += fmt::format("set multiplot layout {},{}\n", down, across);
  std::vector<io::PlotData> data;
  for (const std::size_t k : chosen) {
    const auto name = fmt::format("moment{}", data.size());
    data.push_back(columns(name, all[k]));
    script += fmt::format("set title 't = {:.3g} s' offset 0,-0.7\nplot ${} using 1:2:3:4 with circles lc palette\n",
                          all[k].t, name);
  }
  if (chosen.size() > 1) script += "unset multiplot\n";
  const double aspect = (whole.top - std::min(0.0, whole.bottom)) / (whole.right - whole.left);
  const double width = chosen.size() > 1 ? 470 : 560;
  const int height = std::clamp(static_cast<int>(0.75 * width * aspect) + 90, 150, 700);
  io::plot(file, script, data,
           {.width = static_cast<int>(width) * static_cast<int>(across), .height = height * static_cast<int>(down)});
}

}  // namespace bagnold::report

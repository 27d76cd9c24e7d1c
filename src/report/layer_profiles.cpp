// Layers in one dimension: profiles at several times, the x-t diagram.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/layer_pictures.hpp"

namespace bagnold::report {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// What a run has to show: thickness where the layer has one, else mass per area.
const std::vector<double>& amount(const LayerRun& run, const Layer& layer) {
  return run.layers->of_grains() ? layer.mass : layer.h;
}

const char* amount_label(const LayerRun& run) { return run.layers->of_grains() ? "mass per area" : "thickness h"; }

std::vector<double> abscissae(const LayerGrid& grid) {
  std::vector<double> x;
  for (std::size_t i = 0; i < grid.nx; ++i) x.push_back(grid.x(i));
  return x;
}

// Nothing is drawn where there is next to nothing, but a line may touch the ground beside the layer.
struct Shown {
  std::vector<double> amount, surface, u;
};

Shown shown(const LayerRun& run, const Layer& layer, double least) {
  const auto& a = amount(run, layer);
  const auto& bed = run.layers->grid().bed;
  Shown s{std::vector<double>(a.size(), nan), std::vector<double>(a.size(), nan), std::vector<double>(a.size(), nan)};
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool wet = a[i] > least;
    const bool beside = (i > 0 && a[i - 1] > least) || (i + 1 < a.size() && a[i + 1] > least);
    if (wet || beside) s.amount[i] = wet ? a[i] : 0;
    if (wet || beside) s.surface[i] = bed[i] + s.amount[i];
    if (wet) s.u[i] = layer.u[i];
  }
  return s;
}

struct Panel {
  std::string label;
  int column;
};

Picture profiles_over_x(const LayerRun& run, const std::vector<Layer>& all, double largest) {
  const LayerGrid& grid = run.layers->grid();
  const auto [low, high] = std::minmax_element(grid.bed.begin(), grid.bed.end());
  const bool flat = *high - *low < 1e-9 * largest;
  std::vector<Panel> panels{{amount_label(run), 2}, {"velocity u", 4}};
  if (!flat) panels.insert(panels.begin(), {"surface on the bed", 3});

  const auto times = chosen(all.size(), 6);
  const auto x = abscissae(grid);
  Picture picture{.name = "profiles",
                  .caption = fmt::format("The layer at several times: {} and mean velocity over the depth along the "
                                         "slope; x runs downhill.",
                                         amount_label(run)),
                  .script = axes_style,
                  .data = {},
                  .size = {720, 40 + 230 * static_cast<int>(panels.size())}};
  std::vector<std::string> titles, colours;
  for (std::size_t k = 0; k < times.size(); ++k) {
    // A few grains that leap ahead are no layer with a velocity.
    const Shown s = shown(run, all[times[k]], (run.layers->of_grains() ? 2e-2 : 1e-3) * largest);
    picture.data.push_back({fmt::format("at{}", k), {x, s.amount, s.surface, s.u}});
    titles.push_back(fmt::format("t = {:.4g}", all[times[k]].t));
    colours.push_back(hex(
        colour(time_palette(), times.size() > 1 ? static_cast<double>(k) / static_cast<double>(times.size() - 1) : 0)));
  }
  if (!flat) picture.data.push_back({"bed", {x, grid.bed}});
  picture.script += fmt::format("set multiplot layout {},1\nset lmargin 10\nset rmargin 3\nset xrange [{}:{}]\n",
                                panels.size(), grid.x0, grid.x0 + static_cast<double>(grid.nx) * grid.dx);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    picture.script += fmt::format("set ylabel {}\n{}\n{}\n", in_quotes(panels[p].label),
                                  p == 0 ? "set key outside top center horizontal" : "unset key",
                                  p + 1 == panels.size() ? "set xlabel 'x'" : "unset xlabel");
    std::string plots;
    if (panels[p].column == 3) plots = "$bed using 1:2 with lines lc rgb '#777777' lw 1.5 notitle";
    for (std::size_t k = 0; k < times.size(); ++k)
      plots += fmt::format("{}$at{} using 1:{} with lines lw 1.8 lc rgb '{}' title {}", plots.empty() ? "" : ", ", k,
                           panels[p].column, colours[k], in_quotes(titles[k]));
    picture.script += "plot " + plots + "\n";
  }
  picture.script += "unset multiplot";
  return picture;
}

// At most `most` columns of a row: the largest value of each group of cells, so that nothing thin is lost.
std::vector<double> grouped(const std::vector<double>& row, std::size_t groups) {
  std::vector<double> out(groups, 0.0);
  for (std::size_t i = 0; i < row.size(); ++i) {
    double& most = out[i * groups / row.size()];
    most = std::max(most, row[i]);
  }
  return out;
}

Picture x_t_diagram(const LayerRun& run, const std::vector<Layer>& all, double largest) {
  const LayerGrid& grid = run.layers->grid();
  const std::size_t columns = std::min<std::size_t>(grid.nx, 500), rows = std::min<std::size_t>(all.size(), 400);
  const double t0 = all.front().t, t1 = all.back().t;
  const double length = static_cast<double>(grid.nx) * grid.dx;
  Picture picture{
      .name = "x_t",
      .caption = fmt::format(
          "{} over x and time, from every snapshot. Lines of constant slope are waves and fronts of constant "
          "speed. Dashed: front and tail.",
          run.layers->of_grains() ? "Mass per area" : "Thickness"),
      .script = axes_style,
      .data = {{"field", {{}, {}, {}}}},
      .size = {720, 480}};
  auto& field = picture.data[0].columns;
  double least = largest;
  std::size_t nearest = 0;
  for (std::size_t r = 0; r < rows; ++r) {
    const double t = rows > 1 ? t0 + (t1 - t0) * static_cast<double>(r) / static_cast<double>(rows - 1) : t0;
    while (nearest + 1 < all.size() && std::abs(all[nearest + 1].t - t) <= std::abs(all[nearest].t - t)) ++nearest;
    const auto row = grouped(amount(run, all[nearest]), columns);
    for (std::size_t c = 0; c < columns; ++c) {
      field[0].push_back(grid.x0 + length * (static_cast<double>(c) + 0.5) / static_cast<double>(columns));
      field[1].push_back(t);
      field[2].push_back(row[c]);
      least = std::min(least, row[c]);
    }
  }
  picture.script += set_palette(thickness_palette()) +
                    fmt::format(
                        "set xlabel 'x'\nset ylabel 't'\nset cblabel {}\nset cbrange [{}:{}]\nunset grid\nunset key\n"
                        "set xrange [{}:{}]\nset yrange [{}:{}]\nplot $field using 1:2:3 with image",
                        in_quotes(amount_label(run)), least > 0.3 * largest && least < largest ? least : 0, largest,
                        grid.x0, grid.x0 + length, t0, t1);
  if (run.series != nullptr && run.series->has("front")) {
    auto front = (*run.series)["front"], tail = (*run.series)["tail"];
    for (double& x : front)
      if (x > grid.x0 + length - grid.dx) x = nan;  // it has left
    for (double& x : tail)
      if (x < grid.x0 + grid.dx) x = nan;  // not yet left
    picture.data.push_back({"ends", {front, tail, (*run.series)["t"]}});
    picture.script +=
        ", $ends using 1:3 with lines dt 2 lw 1.2 lc rgb '#d1495b', $ends using 2:3 with lines dt 2 lw 1.2 lc rgb "
        "'#d1495b'";
  }
  return picture;
}

}  // namespace

std::vector<Picture> profile_pictures(const LayerRun& run) {
  std::vector<Layer> all;
  for (std::size_t k = 0; k < run.layers->times().size(); ++k) all.push_back(run.layers->read(k));
  double largest = 0;
  for (const Layer& layer : all)
    for (const double a : amount(run, layer)) largest = std::max(largest, a);
  if (!(largest > 0)) return {};  // nothing has come yet
  std::vector<Picture> pictures{profiles_over_x(run, all, largest)};
  if (all.size() > 1) pictures.push_back(x_t_diagram(run, all, largest));
  return pictures;
}

}  // namespace bagnold::report

// Several layers in one dimension held against each other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "report/layer_pictures.hpp"

namespace bagnold::report {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::size_t nearest(const std::vector<double>& times, double t) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < times.size(); ++k)
    if (std::abs(times[k] - t) < std::abs(times[best] - t)) best = k;
  return best;
}

// Averages over the cells of `to` of a field that is constant in the cells of `from`, and 0 outside.
std::vector<double> averaged(const LayerGrid& from, const std::vector<double>& field, const LayerGrid& to) {
  std::vector<double> sums(to.nx, 0.0);
  for (std::size_t i = 0; i < from.nx; ++i) {
    const double a = from.x0 + static_cast<double>(i) * from.dx, b = a + from.dx;
    const auto cell = [&](double x) {
      return static_cast<std::size_t>(std::clamp((x - to.x0) / to.dx, 0.0, static_cast<double>(to.nx - 1)));
    };
    for (std::size_t k = cell(a); k <= cell(b); ++k) {
      const double left = to.x0 + static_cast<double>(k) * to.dx;
      sums[k] += field[i] * std::max(0.0, std::min(b, left + to.dx) - std::max(a, left)) / to.dx;
    }
  }
  return sums;
}

// x below which `share` of the mass lies, linear within a cell.
double quantile(const LayerGrid& grid, const std::vector<double>& mass, double share) {
  double total = 0, below = 0;
  for (const double m : mass) total += m;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    if (mass[i] > 0 && below + mass[i] >= share * total)
      return grid.x0 + (static_cast<double>(i) + (share * total - below) / mass[i]) * grid.dx;
    below += mass[i];
  }
  return nan;
}

}  // namespace

Comparison compare(const std::vector<LayerRun>& runs) {
  Comparison c;
  double from = -INFINITY, until = INFINITY;
  const LayerGrid* grid = &runs[0].layers->grid();
  for (const LayerRun& run : runs) {
    from = std::max(from, run.layers->times().front());
    until = std::min(until, run.layers->times().back());
    if (run.layers->grid().dx > grid->dx) grid = &run.layers->grid();
    c.names.push_back(run.name);
  }
  for (const double t : runs[0].layers->times())
    if (t >= from && t <= until) c.t.push_back(t);
  if (c.t.empty())
    throw InputError(fmt::format("{} and {}: error: no snapshots at common times", c.names[0], c.names[1]));
  for (std::size_t i = 0; i < grid->nx; ++i) c.x.push_back(grid->x(i));
  for (auto* field : {&c.mass, &c.u}) field->resize(runs.size());
  c.where.resize(runs.size());
  for (std::size_t r = 0; r < runs.size(); ++r)
    for (const double t : c.t) {
      const LayerFile& layers = *runs[r].layers;
      const Layer layer = layers.read(nearest(layers.times(), t));
      std::vector<double> momentum = layer.mass;
      for (std::size_t i = 0; i < momentum.size(); ++i) momentum[i] *= layer.u[i];
      c.mass[r].push_back(averaged(layers.grid(), layer.mass, *grid));
      c.u[r].push_back(averaged(layers.grid(), momentum, *grid));
      for (std::size_t i = 0; i < c.x.size(); ++i) c.u[r].back()[i] /= c.mass[r].back()[i];  // 0/0: no mass
      for (std::size_t q = 0; q < Comparison::shares.size(); ++q)
        c.where[r][q].push_back(quantile(layers.grid(), layer.mass, Comparison::shares[q]));
    }
  return c;
}

void write_comparison(const std::filesystem::path& file, const Comparison& c) {
  std::vector<io::Column> columns{{"t", "time", "time"}, {"x", "length", "middle of the cell"}};
  std::vector<std::vector<double>> cells(2 + 2 * c.names.size());
  for (const auto& name : c.names) {
    columns.push_back({"mass_" + name, "mass/length^2", "mass per area"});
    columns.push_back({"u_" + name, "length/time", "mean velocity of that mass"});
  }
  for (std::size_t k = 0; k < c.t.size(); ++k)
    for (std::size_t i = 0; i < c.x.size(); ++i) {
      cells[0].push_back(c.t[k]);
      cells[1].push_back(c.x[i]);
      for (std::size_t r = 0; r < c.names.size(); ++r) {
        cells[2 + 2 * r].push_back(c.mass[r][k][i]);
        cells[3 + 2 * r].push_back(c.u[r][k][i]);
      }
    }
  io::write_csv(file, columns, cells);
}

Picture compared_picture(const Comparison& c) {
  constexpr int panel_height = 105, ends_height = 290;
  const auto panels = chosen(c.t.size(), 6);
  const int height = 50 + panel_height * static_cast<int>(panels.size()) + ends_height;
  Picture picture{.name = "compared",
                  .caption =
                      "Mass per area of the runs at the same times; below, where the runs are: x below which 1, 50, "
                      "90 and 99 % of the mass lie.",
                  .script = axes_style,
                  .data = {},
                  .size = {720, height}};
  double largest = 0;
  for (const auto& run : c.mass)
    for (const auto& row : run) largest = std::max(largest, *std::max_element(row.begin(), row.end()));
  const double share = static_cast<double>(panel_height) / height;
  picture.script += fmt::format(
      "set multiplot\nset lmargin 10\nset rmargin 12\nset tmargin 0\nset bmargin 1\nset yrange [0:{}]\nset ytics {}\n"
      "set format x ''\nset size 1,{}\n",
      1.1 * largest, tic_step(largest, 4), share);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    std::string plots;
    for (std::size_t r = 0; r < c.names.size(); ++r) {
      const auto name = fmt::format("run{}_{}", r, p);
      picture.data.push_back({name, {c.x, c.mass[r][panels[p]]}});
      plots += fmt::format("{}${} using 1:2 with lines lw 1.8 lt {} title {} noenhanced", r == 0 ? "plot " : ", ", name,
                           r + 1, in_quotes(c.names[r]));
    }
    const bool first = p == 0, last = p + 1 == panels.size();
    picture.script += fmt::format("set origin 0,{}\n{}\n{}\n{}\nset label 1 't = {:.4g}' at graph 1.01, 0.5\n{}\n",
                                  1 - 45.0 / height - share * static_cast<double>(p + 1),
                                  first ? "set key at graph 0.5,1.22 center horizontal" : "unset key",
                                  p == panels.size() / 2 ? "set ylabel 'mass per area'" : "unset ylabel",
                                  last ? "set format x '%g'\nset xlabel 'x' offset 0,0.5" : "", c.t[panels[p]], plots);
  }
  picture.script += fmt::format(
      "set origin 0,0\nset size 1,{}\nunset label 1\nset bmargin 4\nset ytics autofreq\nset tmargin 2\nset yrange "
      "[*:*]\nset xlabel 't' "
      "offset 0,0\n"
      "set ylabel 'x at 1, 50, 90, 99 % of the mass'\nunset key\n",
      static_cast<double>(ends_height) / height);
  std::string plots;
  for (std::size_t r = 0; r < c.names.size(); ++r) {
    const auto name = fmt::format("ends{}", r);
    picture.data.push_back({name, {c.t, c.where[r][0], c.where[r][1], c.where[r][2], c.where[r][3]}});
    for (int column = 2; column <= 5; ++column)
      plots += fmt::format("{}${} using 1:{} with lines lw 1.8 lt {}{}", plots.empty() ? "plot " : ", ", name, column,
                           r + 1, column == 3 || column == 4 ? " dt 2" : "");
  }
  picture.script += plots + "\nunset multiplot";
  return picture;
}

}  // namespace bagnold::report

// Layers in two dimensions: maps over a shaded relief of the bed, sections along and across.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/layer_pictures.hpp"

namespace bagnold::report {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_pixels = 400;  // along the longer side

// The grid as it is drawn: every `stride`-th cell, with the brightness of the relief.
struct Relief {
  std::size_t nx = 0, ny = 0, stride = 1;
  std::vector<double> x, y;        // by column, by row
  std::vector<double> bed, light;  // by pixel
  double low = 0, high = 0;        // of the bed
  double x0 = 0, x1 = 0, y0 = 0, y1 = 0;
};

// Light from the upper left, 45 degrees high.
double brightness(double slope_x, double slope_y) {
  const double n = std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
  return std::max(0.0, (0.5 * slope_x - 0.5 * slope_y + std::sqrt(0.5)) / n);
}

Relief relief(const LayerGrid& grid) {
  Relief r;
  r.stride = (std::max(grid.nx, grid.ny) + most_pixels - 1) / most_pixels;
  r.x0 = grid.x0;
  r.y0 = grid.y0;
  r.x1 = grid.x0 + static_cast<double>(grid.nx) * grid.dx;
  r.y1 = grid.y0 + static_cast<double>(grid.ny) * grid.dy;
  for (std::size_t i = r.stride / 2; i < grid.nx; i += r.stride) r.x.push_back(grid.x(i));
  for (std::size_t j = r.stride / 2; j < grid.ny; j += r.stride) r.y.push_back(grid.y(j));
  r.nx = r.x.size();
  r.ny = r.y.size();
  const auto at = [&](std::size_t i, std::size_t j) { return grid.bed[j * grid.nx + i]; };
  for (std::size_t j = r.stride / 2; j < grid.ny; j += r.stride)
    for (std::size_t i = r.stride / 2; i < grid.nx; i += r.stride) {
      const std::size_t w = i > 0 ? i - 1 : i, e = std::min(i + 1, grid.nx - 1);
      const std::size_t s = j > 0 ? j - 1 : j, n = std::min(j + 1, grid.ny - 1);
      const double sx = e > w ? (at(e, j) - at(w, j)) / (static_cast<double>(e - w) * grid.dx) : 0;
      const double sy = n > s ? (at(i, n) - at(i, s)) / (static_cast<double>(n - s) * grid.dy) : 0;
      r.bed.push_back(at(i, j));
      r.light.push_back(brightness(sx, sy));
    }
  const auto [low, high] = std::minmax_element(grid.bed.begin(), grid.bed.end());
  r.low = *low;
  r.high = *high;
  return r;
}

struct Scale {
  Palette palette;
  double low = 0, high = 1, exponent = 1;
  std::string label;
};

// Pixels with their colours: the relief in grey, and over it the values that are numbers.
io::PlotData pixels(const std::string& name, const Relief& r, const LayerGrid& grid, const std::vector<double>& values,
                    const Scale& scale) {
  io::PlotData data{name, std::vector<std::vector<double>>(5)};
  for (std::size_t j = 0; j < r.ny; ++j)
    for (std::size_t i = 0; i < r.nx; ++i) {
      const std::size_t cell = (r.stride / 2 + j * r.stride) * grid.nx + r.stride / 2 + i * r.stride;
      const double light = r.light[j * r.nx + i], grey = 255 * (0.4 + 0.6 * std::min(1.0, light / 0.9));
      Rgb shown{grey, grey, grey};
      if (std::isfinite(values[cell])) {
        const double share = std::clamp((values[cell] - scale.low) / (scale.high - scale.low), 0.0, 1.0);
        const Rgb over = colour(scale.palette, std::pow(share, 1 / scale.exponent));
        for (std::size_t c = 0; c < 3; ++c) shown[c] = 0.12 * grey + 0.88 * over[c] * (0.7 + 0.3 * grey / 255);
      }
      const double row[] = {r.x[i], r.y[j], std::round(shown[0]), std::round(shown[1]), std::round(shown[2])};
      for (std::size_t c = 0; c < 5; ++c) data.columns[c].push_back(row[c]);
    }
  return data;
}

// The bed as a matrix, and the commands that turn it into contour lines.
std::string contours(const Relief& r, std::vector<io::PlotData>& data) {
  if (!(r.high > r.low)) return "$contours << EOD\nNaN NaN\nEOD\n";
  io::PlotData bed{"bed", std::vector<std::vector<double>>(r.nx)};
  for (std::size_t i = 0; i < r.nx; ++i)
    for (std::size_t j = 0; j < r.ny; ++j) bed.columns[i].push_back(r.bed[j * r.nx + i]);
  data.push_back(std::move(bed));
  const double step_x = r.nx > 1 ? r.x[1] - r.x[0] : 1, step_y = r.ny > 1 ? r.y[1] - r.y[0] : 1;
  return fmt::format(
      "set contour base\nset cntrparam levels auto 14\nunset surface\nset table $contours\n"
      "splot $bed matrix using ({}+$1*{}):({}+$2*{}):3\nunset table\nunset contour\nset surface\n",
      r.x[0], step_x, r.y[0], step_y);
}

std::string map_style(const Relief& r) {
  return std::string(axes_style) +
         fmt::format(
             "unset grid\nset size ratio -1\nset xrange [{}:{}]\nset yrange [{}:{}]\nset format x '%.0f'\nset format y "
             "'%.0f'\n"
             "set xtics {}\nset ytics {}\nset key off\nset xlabel 'x'\nset ylabel 'y'\nset colorbox\n",
             r.x0, r.x1, r.y0, r.y1, tic_step(r.x1 - r.x0, 4), tic_step(r.y1 - r.y0, 4)) +
         fmt::format("$corner << EOD\n{0} {1} 0\n{0} {1} 0\nEOD\n", r.x0, r.y0);
}

// The line of no length makes gnuplot draw the colour bar, which an image in full colour does not have.
std::string map_plot(const std::string& block, const Scale& scale) {
  return set_palette(scale.palette, scale.exponent) +
         fmt::format(
             "set cbrange [{}:{}]\nset cblabel {}\n"
             "plot ${} using 1:2:3:4:5 with rgbimage, $contours using 1:2 with lines lw 0.5 lc rgb '#606060', "
             "$corner using 1:2:3 with lines lc palette\n",
             scale.low, scale.high, in_quotes(scale.label), block);
}

io::PlotSize map_size(const Relief& r, int width) {
  const double aspect = (r.y1 - r.y0) / (r.x1 - r.x0);
  return {width, std::clamp(static_cast<int>(0.72 * width * aspect) + 90, 180, 2 * width)};
}

std::vector<double> above(const std::vector<double>& values, const std::vector<double>& thickness, double least) {
  std::vector<double> out(values.size(), nan);
  for (std::size_t k = 0; k < values.size(); ++k)
    if (thickness[k] > least) out[k] = values[k];
  return out;
}

Picture one_map(const std::string& name, const std::string& caption, const Relief& r, const LayerGrid& grid,
                const std::vector<double>& values, const Scale& scale) {
  Picture picture{.name = name, .caption = caption, .script = {}, .data = {}, .size = map_size(r, 720)};
  picture.script = map_style(r) + contours(r, picture.data);
  picture.data.push_back(pixels("map", r, grid, values, scale));
  picture.script += map_plot("map", scale);
  return picture;
}

Picture thickness_in_time(const LayerRun& run, const Relief& r, double largest, double least) {
  const LayerGrid& grid = run.layers->grid();
  const auto which = chosen(run.layers->times().size(), 4);
  const Scale scale{.palette = hot_palette(), .high = largest, .exponent = 2, .label = "h"};
  const int rows = static_cast<int>(which.size() + 1) / 2;
  io::PlotSize size = map_size(r, 470);
  size = {2 * size.width, rows * size.height};
  Picture picture{.name = "thickness_in_time",
                  .caption = "Thickness at several times over the shaded bed and its contours; one scale for all.",
                  .script = {},
                  .data = {},
                  .size = size};
  picture.script = map_style(r) + contours(r, picture.data) +
                   fmt::format("set multiplot layout {},{}\n", rows, which.size() > 1 ? 2 : 1);
  for (std::size_t k = 0; k < which.size(); ++k) {
    const Layer layer = run.layers->read(which[k]);
    const auto name = fmt::format("map{}", k);
    picture.data.push_back(pixels(name, r, grid, above(layer.h, layer.h, least), scale));
    picture.script += fmt::format("set title 't = {:.4g}'\n", layer.t) + map_plot(name, scale);
  }
  picture.script += "unset multiplot";
  return picture;
}

// By column, the row where the layer once was thickest: the way the flow took, if it went along x.
std::vector<std::size_t> path_of(const LayerGrid& grid, const std::vector<double>& max_h) {
  std::vector<std::size_t> path(grid.nx, 0);
  for (std::size_t i = 0; i < grid.nx; ++i)
    for (std::size_t j = 0; j < grid.ny; ++j)
      if (max_h[j * grid.nx + i] > max_h[path[i] * grid.nx + i]) path[i] = j;
  // Where nothing came: go straight on from the nearest column on the left that saw something, or to the first.
  std::size_t first = 0;
  while (first + 1 < grid.nx && !(max_h[path[first] * grid.nx + first] > 0)) ++first;
  for (std::size_t i = 0; i < grid.nx; ++i)
    if (!(max_h[path[i] * grid.nx + i] > 0)) path[i] = i < first ? path[first] : path[i - 1];
  return path;
}

// In the middle of what lies there.
std::size_t middle_column(const LayerGrid& grid, const std::vector<double>& h) {
  std::vector<double> sums(grid.nx, 0.0);
  double total = 0, below = 0;
  for (std::size_t j = 0; j < grid.ny; ++j)
    for (std::size_t i = 0; i < grid.nx; ++i) {
      sums[i] += h[j * grid.nx + i];
      total += h[j * grid.nx + i];
    }
  for (std::size_t i = 0; i < grid.nx; ++i)
    if ((below += sums[i]) >= 0.5 * total) return i;
  return grid.nx / 2;
}

Picture sections(const LayerRun& run, const LayerExtremes& extremes) {
  const LayerGrid& grid = run.layers->grid();
  const auto which = chosen(run.layers->times().size(), 5);
  std::vector<Layer> layers;
  for (const std::size_t k : which) layers.push_back(run.layers->read(k));
  const auto path = path_of(grid, extremes.max_h);
  const std::size_t column = middle_column(grid, layers.back().h);
  Picture picture{.name = "sections",
                  .caption = fmt::format(
                      "Left: bed and thickness along the row that saw the thickest layer at each x. Right: across "
                      "at x = {:.6g}, the middle of what lies there in the end. Thickness is normal to the bed.",
                      grid.x(column)),
                  .script = axes_style,
                  .data = {},
                  .size = {900, 480}};
  const auto bed_along = [&](bool along) {
    std::vector<double> out;
    for (std::size_t k = 0; k < (along ? grid.nx : grid.ny); ++k)
      out.push_back(along ? grid.bed[path[k] * grid.nx + k] : grid.bed[k * grid.nx + column]);
    return out;
  };
  const auto thickness_along = [&](const std::vector<double>& h, bool along) {
    std::vector<double> out(along ? grid.nx : grid.ny, 0.0);
    for (std::size_t j = 0; j < grid.ny; ++j) {
      if (!along) out[j] = h[j * grid.nx + column];
      if (along)
        for (std::size_t i = 0; i < grid.nx; ++i) out[i] = std::max(out[i], h[j * grid.nx + i]);
    }
    return out;
  };
  for (const bool along : {true, false}) {
    io::PlotData data{along ? "along" : "across", {{}, bed_along(along)}};
    for (std::size_t k = 0; k < (along ? grid.nx : grid.ny); ++k)
      data.columns[0].push_back(along ? grid.x(k) : grid.y(k));
    for (const Layer& layer : layers) data.columns.push_back(thickness_along(layer.h, along));
    data.columns.push_back(thickness_along(extremes.max_h, along));
    picture.data.push_back(std::move(data));
  }
  const auto axis = [&](bool along) {
    const double low = along ? grid.x0 : grid.y0;
    const double size = along ? static_cast<double>(grid.nx) * grid.dx : static_cast<double>(grid.ny) * grid.dy;
    return fmt::format("set xrange [{}:{}]\nset xtics {}\n", low, low + size, tic_step(size, 4));
  };
  std::string entries = ", keyentry with lines dt 2 lc rgb '#777777' title 'largest'";
  std::string curves = fmt::format(" using 1:{} with lines dt 2 lc rgb '#777777'", layers.size() + 3);
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const double share = layers.size() > 1 ? static_cast<double>(k) / static_cast<double>(layers.size() - 1) : 0;
    const auto line = fmt::format("with lines lw 1.8 lc rgb '{}'", hex(colour(time_palette(), share)));
    entries += fmt::format(", keyentry {} title 't = {:.4g}'", line, layers[k].t);
    curves += fmt::format(", '' using 1:{} {}", k + 3, line);
  }
  const double floor = *std::min_element(grid.bed.begin(), grid.bed.end());
  const auto bed = [&](const char* block) {
    return fmt::format(
        "plot ${0} using 1:2 with filledcurves y1={1} fc rgb '#cccccc' notitle, ${0} using 1:2 with lines lc rgb "
        "'#777777' notitle",
        block, floor);
  };
  const auto thickness = [&](const char* block) { return fmt::format("plot ${}{}\n", block, curves); };
  picture.script +=
      "set multiplot layout 2,2\nset lmargin 9\nset rmargin 4\nset format x '%.0f'\n"
      "set ylabel 'bed'\nunset xlabel\nset key top right\n" +
      axis(true) + bed("along") + entries + "\nunset key\nunset ylabel\n" + axis(false) + bed("across") +
      "\nset ylabel 'thickness h'\nset xlabel 'x'\n" + axis(true) + thickness("along") +
      "unset ylabel\nset xlabel 'y'\n" + axis(false) + thickness("across") + "unset multiplot";
  return picture;
}

double largest_of(const std::vector<double>& values) {
  double most = 0;
  for (const double v : values)
    if (std::isfinite(v)) most = std::max(most, v);
  return most;
}

}  // namespace

std::vector<Picture> map_pictures(const LayerRun& run) {
  const LayerGrid& grid = run.layers->grid();
  const LayerExtremes extremes = run.layers->extremes();
  const double largest = largest_of(extremes.max_h), fastest = largest_of(extremes.max_speed),
               latest = largest_of(extremes.arrival);
  if (!(largest > 0)) return {};  // nothing has come yet
  const double least = 1e-3 * largest;
  const Relief r = relief(grid);
  std::vector<Picture> pictures{thickness_in_time(run, r, largest, least)};
  pictures.push_back(one_map("max_thickness", "Largest thickness of the whole run.", r, grid,
                             above(extremes.max_h, extremes.max_h, least),
                             {.palette = hot_palette(), .high = largest, .exponent = 2, .label = "largest h"}));
  if (fastest > 0)
    pictures.push_back(one_map("max_speed", "Largest speed of the whole run.", r, grid,
                               above(extremes.max_speed, extremes.max_h, least),
                               {.palette = hot_palette(), .high = fastest, .exponent = 1, .label = "largest speed"}));
  if (latest > 0)
    pictures.push_back(one_map("arrival", "When the layer first was thicker than observe.arrival_depth.", r, grid,
                               extremes.arrival,
                               {.palette = time_palette(), .high = latest, .exponent = 1, .label = "time of arrival"}));
  pictures.push_back(sections(run, extremes));
  return pictures;
}

}  // namespace bagnold::report

// Figures as data: what is drawn is decided here, how it looks in draw().
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "report/run_data.hpp"

namespace bagnold::report {

enum class Stroke { line, dashed, points };

struct Curve {
  std::string label;
  std::vector<double> x, y;  // NaN is a gap
  Stroke stroke = Stroke::line;
};

struct Figure {
  std::string name;     // of the file
  std::string caption;  // a sentence: what is seen, and what it should look like
  std::string x_label, y_label;
  bool log_x = false, log_y = false;
  std::vector<Curve> curves;
};

// Every figure that the files of the runs allow, each with all runs in it: energies and energy ratio in time, depth
// profiles of velocity (with Bagnold's), solid fraction, stresses (with the weight above), friction and temperature, solid fraction for several kernel widths, momentum residual against averaging time. A
// series that holds none of the known columns is drawn column by column.
std::vector<Figure> figures(std::span<const RunData> runs);

// Draws with gnuplot; the kind of file (.svg, .png, .pdf) is that of the name.
void draw(const Figure& figure, const std::filesystem::path& file);

}  // namespace bagnold::report

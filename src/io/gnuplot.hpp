// Figures, by the gnuplot program.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace bagnold::io {

// Data for a script: columns of equal length, plotted as `plot $name using 1:2`. NaN is a gap.
struct PlotData {
  std::string name;
  std::vector<std::vector<double>> columns;
};

struct PlotSize {
  int width = 640, height = 420;  // pixels; points for a PDF
};

// Runs `script` with `data` at hand; the figure goes to `output`, its kind (.svg, .png, .pdf) is that of the
// name. Throws IoError when gnuplot is missing (the text says which package to install) or reports an error.
void plot(const std::filesystem::path& output, const std::string& script, const std::vector<PlotData>& data,
          const PlotSize& size = {});

bool have_gnuplot();

}  // namespace bagnold::io

// A picture that is more than curves over an axis: a gnuplot script and its data, not yet drawn. And what all have in
// common: the look of axes, colours.
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "io/gnuplot.hpp"

namespace bagnold::report {

struct Picture {
  std::string name;     // of the file
  std::string caption;  // what is seen
  std::string script;
  std::vector<io::PlotData> data;
  io::PlotSize size;
};

inline constexpr const char* axes_style =
    "set border 3 lc rgb '#555555'\nset tics nomirror out\nset grid lc rgb '#dddddd' lw 0.5\n"
    "set linetype 1 lc rgb '#0b5fa5'\nset linetype 2 lc rgb '#d1495b'\nset linetype 3 lc rgb '#2e8b57'\n"
    "set linetype 4 lc rgb '#8a5fbf'\nset linetype 5 lc rgb '#e08e1b'\nset linetype 6 lc rgb '#444444'\n";

// The text as gnuplot reads it.
std::string in_quotes(const std::string& text);

// A step of 1, 2 or 5 times a power of ten that leaves at most about `most` tics on an axis of this length.
double tic_step(double length, int most);

using Rgb = std::array<double, 3>;  // 0 to 255
using Palette = std::span<const Rgb>;
Palette thickness_palette();                // white to dark blue, so that nothing is white
Palette hot_palette();                      // yellow to dark red, over a grey relief
Palette time_palette();                     // dark to bright: lines of different times, arrival
Rgb colour(Palette palette, double share);  // share 0 to 1
std::string hex(const Rgb& colour);         // '#rrggbb'
// The command. `exponent` 2: colours are spread evenly over the square root of the value.
std::string set_palette(Palette palette, double exponent = 1);

}  // namespace bagnold::report

// A look at the grains themselves: the front layer of the last snapshot from the side, coloured by speed.
#pragma once
#include <filesystem>

namespace bagnold::report {

// Draws the last snapshot of `run` (a run directory of the particle model) to `file` (.svg, .png or .pdf). Nothing is
// drawn, and false returned, when the run holds no grains. Throws IoError when gnuplot is missing.
bool draw_grains(const std::filesystem::path& run, const std::filesystem::path& file);

}  // namespace bagnold::report

// A look at the grains themselves: the front layer of the last snapshot from the side, coloured by speed.
#pragma once
#include <filesystem>

namespace bagnold::report {

// Whether `run`, a run directory, holds a snapshot with flowing grains.
bool has_grains(const std::filesystem::path& run);

// Draws the last snapshot of `run`, which has grains, to `file` (.svg, .png or .pdf). Throws IoError when gnuplot is
// missing.
void draw_grains(const std::filesystem::path& run, const std::filesystem::path& file);

}  // namespace bagnold::report

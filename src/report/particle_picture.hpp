// A look at the particles of the continuum model: how a column collapses, how a flow is layered.
#pragma once
#include <filesystem>

namespace bagnold::report {

// Whether the run directory holds snapshots of such particles.
bool has_particles(const std::filesystem::path& run);

// Draws snapshots of `run` (a run directory of the continuum model) to `file` (.svg, .png or .pdf), particles coloured by
// speed: of a column six moments at equal steps of the front, the first and the last snapshot among them, with the outline
// of the first (Minatti & Paris 2015, figures 11 and 12); of a periodic flow the last one (figure 8). In 3D a slice through the middle.
// Throws IoError when gnuplot is missing.
void draw_particles(const std::filesystem::path& run, const std::filesystem::path& file);

}  // namespace bagnold::report

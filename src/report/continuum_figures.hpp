// Figures of the continuum model.
#pragma once
#include <span>
#include <vector>

#include "report/figures.hpp"

namespace bagnold::report {

// Of columns: advance of the front and height in time (Minatti & Paris 2015, figure 10), and with several runs the
// run-out against the aspect ratio with the laws measured by Lube et al. (figure 13). Of the inclined plane: velocity and
// pressure over the depth with the analytic ones (figures 6 and 7), mean velocity in time. None for other models.
std::vector<Figure> continuum_figures(std::span<const RunData> runs);

}  // namespace bagnold::report

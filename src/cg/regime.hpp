// Which kind of flow a run has reached, from its energies and, for layers, from its density profile
// (Weinhart et al. 2012, sections 6 and 8).
#pragma once
#include <optional>
#include <span>
#include <string_view>

namespace bagnold::cg {

enum class Regime { arrested, steady, accelerating, oscillating, layered };
std::string_view name_of(Regime regime);

// Samples of the energies, in order of time.
struct EnergySeries {
  std::span<const double> t, kinetic, elastic;
};

// The thresholds. The ratio is R = E_kin / <E_ela>; the paper compares R over the last tenth of the run.
struct RegimeCriteria {
  double arrested_ratio = 1e-5;  // arrested: R falls below this ...
  double arrested_after = 10;    // ... at some time after this one (the initial fall is over)
  double window = 0.1;           // part of the run, at its end, over which R has to be constant
  double least_window = 50;      // but no shorter than this (at most half the run)
  double growth = 0.05;          // steady: the linear trend changes R by less than this part over a window, ...
  double growth_errors = 3;      // ... or by less than so many standard errors of the trend
  double swing = 0.1;  // oscillating: standard deviation of the detrended R, averaged over unit times, over its mean
  double layer_order = 0.1;  // layered: FlowNumbers::layering above this in a flow that is otherwise steady
};

struct RegimeReport {
  std::optional<Regime> regime;  // nothing: no samples, or a flow that slows down without having stopped
  std::optional<double> energy_ratio, energy_ratio_err;  // mean of R over the window
  std::optional<double> growth, swing;                   // as in the criteria
};

// `layering` of the averaged profile; nothing if it is not known. E_ela is averaged over the second half of the series,
// as in the paper.
RegimeReport classify(const EnergySeries& energies, std::optional<double> layering,
                      const RegimeCriteria& criteria = {});

}  // namespace bagnold::cg

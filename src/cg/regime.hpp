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

// The thresholds. The ratio is R = E_kin / <E_ela>, judged over the second half of the run, where the paper averages E_ela.
// Over a window whose ends are so far apart a flow that speeds up evenly has R grow like t^2, one in balance not at all
// but for its slow modes: tens of (d/g)^1/2 long and several per cent of R in flows of a thousand grains. R like t^(1/2)
// is half a power above those and 5 per cent over the last tenth of the run, which the paper looks at.
struct RegimeCriteria {
  double arrested_ratio = 1e-5;  // arrested: R falls below this ...
  double arrested_after = 10;    // ... at some time after this one (the initial fall is over)
  double exponent = 0.5;         // accelerating: R grows faster than this power of time ...
  double errors = 3;             // ... by a trend of more than so many standard errors, correlated noise considered
  double swing = 0.1;  // oscillating: standard deviation of the detrended R, averaged over unit times, over its mean
  double layer_order = 0.3;  // layered: FlowNumbers::layering above this in a flow that is otherwise steady
};

struct RegimeReport {
  std::optional<Regime> regime;  // nothing: no samples, or a flow that slows down without having stopped
  std::optional<double> energy_ratio, energy_ratio_err;  // mean of R over the window
  std::optional<double> growth, growth_err;              // the power of time with which R grows
  std::optional<double> swing;                           // as in the criteria
};

// `layering` of the averaged profile; nothing if it is not known. E_ela is averaged over the second half of the series,
// as in the paper.
RegimeReport classify(const EnergySeries& energies, std::optional<double> layering,
                      const RegimeCriteria& criteria = {});

}  // namespace bagnold::cg

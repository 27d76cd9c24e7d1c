#include "cg/regime.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace bagnold::cg {
namespace {

double mean_of(const std::vector<double>& f) {
  double sum = 0;
  for (double v : f) sum += v;
  return f.empty() ? 0 : sum / static_cast<double>(f.size());
}

// Means over equal pieces of time, so that neither the sampling rate nor single collisions matter.
struct Pieces {
  std::vector<double> t, value;
};

Pieces averages(std::span<const double> t, const std::vector<double>& f, std::size_t pieces) {
  Pieces out;
  const double begin = t.front(), end = t.back();
  std::vector<double> sum(pieces), count(pieces);
  for (std::size_t n = 0; n < t.size(); ++n) {
    const auto k = static_cast<std::size_t>(static_cast<double>(pieces) * (t[n] - begin) / (end - begin));
    sum[std::min(k, pieces - 1)] += f[n];
    count[std::min(k, pieces - 1)] += 1;
  }
  for (std::size_t k = 0; k < pieces; ++k) {
    if (count[k] == 0) continue;
    out.t.push_back(begin + (static_cast<double>(k) + 0.5) / static_cast<double>(pieces) * (end - begin));
    out.value.push_back(sum[k] / count[k]);
  }
  return out;
}

struct Trend {
  double slope, deviation;  // deviation: standard deviation of what the line leaves
  double slope_err, mean_err;
};

// Standard errors are those of noise whose correlation decays like that of neighbouring pieces, r^k: sqrt((1 + r)/(1 - r)) times
// those of independent pieces. Fitting a line has made r too small by (1 + 3 r)/n.
Trend fit_line(const Pieces& p) {
  const double t0 = mean_of(p.t), f0 = mean_of(p.value), n = static_cast<double>(p.t.size());
  double tt = 0, tf = 0;
  for (std::size_t k = 0; k < p.t.size(); ++k) {
    tt += (p.t[k] - t0) * (p.t[k] - t0);
    tf += (p.t[k] - t0) * (p.value[k] - f0);
  }
  const double slope = tf / tt;
  double rest = 0, product = 0, previous = 0;
  for (std::size_t k = 0; k < p.t.size(); ++k) {
    const double left = p.value[k] - f0 - slope * (p.t[k] - t0);
    rest += left * left;
    product += left * previous;
    previous = left;
  }
  const double r = rest > 0 ? product / rest : 0, correlation = std::clamp((n * r + 1) / (n - 3), 0.0, 0.9);
  const double deviation = std::sqrt(rest / (n - 2)), longer = std::sqrt((1 + correlation) / (1 - correlation));
  return {slope, deviation, longer * deviation / std::sqrt(tt), longer * deviation / std::sqrt(n)};
}

bool has_arrested(const EnergySeries& e, double mean_elastic, const RegimeCriteria& c) {
  for (std::size_t n = 0; n < e.t.size(); ++n)
    if (e.t[n] > c.arrested_after && e.elastic[n] > 0 &&
        e.kinetic[n] < c.arrested_ratio * std::min(mean_elastic, e.elastic[n]))
      return true;
  return false;
}

}  // namespace

std::string_view name_of(Regime regime) {
  constexpr std::array<std::string_view, 5> names{"arrested", "steady", "accelerating", "oscillating", "layered"};
  return names[static_cast<std::size_t>(regime)];
}

RegimeReport classify(const EnergySeries& e, std::optional<double> layering, const RegimeCriteria& c) {
  RegimeReport out;
  if (e.t.size() < 2 || !(e.t.back() > e.t.front())) return out;
  const double end = e.t.back(), begin = 0.5 * (e.t.front() + end);
  const auto first = static_cast<std::size_t>(std::lower_bound(e.t.begin(), e.t.end(), begin) - e.t.begin());
  const double mean_elastic = mean_of({e.elastic.begin() + static_cast<std::ptrdiff_t>(first), e.elastic.end()});
  if (!(mean_elastic > 0)) return out;

  std::vector<double> ratio;
  for (std::size_t n = first; n < e.t.size(); ++n) ratio.push_back(e.kinetic[n] / mean_elastic);
  const double mean = mean_of(ratio);
  out.energy_ratio = mean;
  if (has_arrested(e, mean_elastic, c)) {
    out.regime = Regime::arrested;
    return out;
  }
  const std::span<const double> times = e.t.subspan(first);
  // Unit times (d/g)^1/2 are long against collisions and short against the swings of oscillating flow.
  const auto pieces = static_cast<std::size_t>(std::clamp(end - begin, 16.0, 1000.0));
  const Pieces fine = averages(times, ratio, pieces), coarse = averages(times, ratio, 16);
  if (fine.t.size() < 16 || coarse.t.size() < 16) return out;
  Pieces powers = coarse;
  for (double& t : powers.t) t = std::log(t);
  for (double& f : powers.value) f = std::log(std::max(f, c.arrested_ratio * mean));
  const Trend power = fit_line(powers);
  out.energy_ratio_err = fit_line(coarse).mean_err;
  out.growth = power.slope;
  out.growth_err = power.slope_err;
  out.swing = fit_line(fine).deviation / mean;
  if (std::abs(*out.growth) > std::max(c.exponent, c.errors * *out.growth_err))
    out.regime = *out.growth > 0 ? std::optional(Regime::accelerating) : std::nullopt;
  else if (*out.swing > c.swing)
    out.regime = Regime::oscillating;
  else
    out.regime = layering && *layering > c.layer_order ? Regime::layered : Regime::steady;
  return out;
}

}  // namespace bagnold::cg

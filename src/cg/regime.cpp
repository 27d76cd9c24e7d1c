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
  double slope, slope_err, deviation;  // deviation: standard deviation of what the line leaves
};

Trend fit_line(const Pieces& p) {
  const double t0 = mean_of(p.t), f0 = mean_of(p.value), n = static_cast<double>(p.t.size());
  double tt = 0, tf = 0, rest = 0;
  for (std::size_t k = 0; k < p.t.size(); ++k) {
    tt += (p.t[k] - t0) * (p.t[k] - t0);
    tf += (p.t[k] - t0) * (p.value[k] - f0);
  }
  const double slope = tf / tt;
  for (std::size_t k = 0; k < p.t.size(); ++k) rest += std::pow(p.value[k] - f0 - slope * (p.t[k] - t0), 2);
  return {slope, std::sqrt(rest / (n - 2) / tt), std::sqrt(rest / (n - 2))};
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
  const double end = e.t.back(), duration = end - e.t.front();
  std::vector<double> late;
  for (std::size_t n = 0; n < e.t.size(); ++n)
    if (e.t[n] >= end - 0.5 * duration) late.push_back(e.elastic[n]);
  const double mean_elastic = mean_of(late);
  if (!(mean_elastic > 0)) return out;

  const double window = std::min(std::max(c.window * duration, c.least_window), 0.5 * duration);
  const auto first = static_cast<std::size_t>(std::lower_bound(e.t.begin(), e.t.end(), end - window) - e.t.begin());
  std::vector<double> ratio;
  for (std::size_t n = first; n < e.t.size(); ++n) ratio.push_back(e.kinetic[n] / mean_elastic);
  out.energy_ratio = mean_of(ratio);
  if (has_arrested(e, mean_elastic, c)) {
    out.regime = Regime::arrested;
    return out;
  }
  const std::span<const double> times = e.t.subspan(first);
  // Unit times (d/g)^1/2 are long against collisions and short against the swings of oscillating flow.
  const auto pieces = static_cast<std::size_t>(std::clamp(window, 8.0, 400.0));
  const Pieces fine = averages(times, ratio, pieces), coarse = averages(times, ratio, 8);
  if (fine.t.size() < 8 || coarse.t.size() < 8) return out;
  const Trend slow = fit_line(coarse), fast = fit_line(fine);
  out.energy_ratio_err = slow.deviation / std::sqrt(8.0);
  out.growth = slow.slope * window / *out.energy_ratio;
  out.swing = fast.deviation / *out.energy_ratio;
  const bool trend = std::abs(*out.growth) > c.growth && std::abs(slow.slope) > c.growth_errors * slow.slope_err;
  if (*out.swing > c.swing && !trend)
    out.regime = Regime::oscillating;
  else if (trend)
    out.regime = slow.slope > 0 ? std::optional(Regime::accelerating) : std::nullopt;
  else
    out.regime = layering && *layering > c.layer_order ? Regime::layered : Regime::steady;
  return out;
}

}  // namespace bagnold::cg

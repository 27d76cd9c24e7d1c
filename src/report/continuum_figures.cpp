#include "report/continuum_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bagnold::report {
namespace {

bool is_continuum(const RunData& run, const std::string& scenario) {
  const auto text = [&](const char* key) {
    return run.summary.contains(key) && run.summary[key].is_string() ? run.summary[key].get<std::string>() : "";
  };
  return text("model") == "sph" && text("scenario") == scenario;
}

double top_level(const RunData& run, const std::string& key) {
  const auto found = run.summary.find(key);
  return found == run.summary.end() || !found->is_number() ? std::numeric_limits<double>::quiet_NaN()
                                                           : found->get<double>();
}

void add_front(std::vector<Figure>& all, std::span<const RunData> runs) {
  Figure front{.name = "front",
               .caption =
                   "Advance of the front in time: connected material (lines) and the farthest particle (dashed); the "
                   "front stops (Minatti & Paris 2015, figure 10).",
               .x_label = "t, s",
               .y_label = "front - r_0, m",
               .curves = {}};
  Figure height{.name = "height",
                .caption = "Height of the connected material in time.",
                .x_label = "t, s",
                .y_label = "height, m",
                .curves = {}};
  for (const auto& run : runs) {
    if (!is_continuum(run, "column") || !run.series) continue;
    const double r0 = top_level(run, "r0");
    const auto& t = run.series->cells[0];
    const auto advance = [&](const char* column) {
      auto values = (*run.series)[column];
      for (double& v : values) v -= r0;
      return values;
    };
    const std::string label = runs.size() > 1 ? run.name : "";
    front.curves.push_back({label, t, advance("front")});
    front.curves.push_back({"", t, advance("front_raw"), Stroke::dashed});
    height.curves.push_back({label, t, (*run.series)["height"]});
  }
  if (front.curves.empty()) return;
  all.push_back(std::move(front));
  all.push_back(std::move(height));
}

// Laws measured on sand: (r1 - r0)/r0 = 1.24 a, 1.6 sqrt(a) beyond 1.7 (Lube et al. 2004); planar 1.2 a, 1.9 a^(2/3)
// beyond 1.8 (Lube et al. 2005).
void add_scaling(std::vector<Figure>& all, std::span<const RunData> runs) {
  std::vector<std::pair<double, double>> points;
  for (const auto& run : runs)
    if (is_continuum(run, "column")) points.emplace_back(top_level(run, "aspect_ratio"), top_level(run, "runout"));
  if (points.size() < 2) return;
  std::sort(points.begin(), points.end());
  Figure figure{.name = "scaling",
                .caption =
                    "Run-out (r1 - r0)/r0 against aspect ratio, with the laws measured by Lube et al. (2004, "
                    "2005) (Minatti & Paris 2015, figure 13).",
                .x_label = "a = H_0/r_0",
                .y_label = "(r_1 - r_0)/r_0",
                .curves = {}};
  const double most = std::max(1.8, 1.1 * points.back().first);
  Curve axisymmetric{.label = "experiments, axisymmetric", .x = {}, .y = {}},
      planar{.label = "experiments, planar", .x = {}, .y = {}, .stroke = Stroke::dashed},
      runs_here{.label = "runs", .x = {}, .y = {}, .stroke = Stroke::points};
  constexpr int steps = 200;
  for (int k = 0; k <= steps; ++k) {
    const double a = most * k / steps;
    axisymmetric.x.push_back(a);
    axisymmetric.y.push_back(a < 1.7 ? 1.24 * a : 1.6 * std::sqrt(a));
    planar.x.push_back(a);
    planar.y.push_back(a < 1.8 ? 1.2 * a : 1.9 * std::cbrt(a * a));
  }
  for (const auto& [a, runout] : points) runs_here.x.push_back(a), runs_here.y.push_back(runout);
  figure.curves = {std::move(axisymmetric), std::move(planar), std::move(runs_here)};
  all.push_back(std::move(figure));
}

void add_plane(std::vector<Figure>& all, std::span<const RunData> runs) {
  Figure pressure{.name = "pressure",
                  .caption = "Pressure over the depth; dashed: hydrostatic (Minatti & Paris 2015, figure 7).",
                  .x_label = "p, Pa",
                  .y_label = "z, m",
                  .curves = {}};
  Figure velocity{
      .name = "velocity",
      .caption =
          "Velocity over the depth; dashed: the analytic steady profile, eq. 56 (Minatti & Paris 2015, figure 6).",
      .x_label = "u, m/s",
      .y_label = "z, m",
      .curves = {}};
  Figure mean{.name = "mean_velocity",
              .caption = "Mean velocity down the slope in time.",
              .x_label = "t, s",
              .y_label = "mean u, m/s",
              .curves = {}};
  for (const auto& run : runs) {
    if (!is_continuum(run, "inclined_plane")) continue;
    const std::string label = runs.size() > 1 ? run.name : "";
    if (run.profile) {
      const auto& z = (*run.profile)["z"];
      velocity.curves.push_back({label, (*run.profile)["u_x"], z});
      velocity.curves.push_back({"", (*run.profile)["u_x_exact"], z, Stroke::dashed});
      pressure.curves.push_back({label, (*run.profile)["p"], z});
      pressure.curves.push_back({"", (*run.profile)["p_exact"], z, Stroke::dashed});
    }
    if (run.series) mean.curves.push_back({label, run.series->cells[0], (*run.series)["u_mean"]});
  }
  for (auto* figure : {&velocity, &pressure, &mean})
    if (!figure->curves.empty()) all.push_back(std::move(*figure));
}

}  // namespace

std::vector<Figure> continuum_figures(std::span<const RunData> runs) {
  std::vector<Figure> all;
  add_front(all, runs);
  add_scaling(all, runs);
  add_plane(all, runs);
  return all;
}

}  // namespace bagnold::report

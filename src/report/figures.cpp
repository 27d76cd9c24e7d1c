#include "report/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "io/gnuplot.hpp"
#include "report/continuum_figures.hpp"
#include "report/picture.hpp"

namespace bagnold::report {
namespace {

using Label = std::pair<std::string, std::string>;  // column, what the legend calls it

// A figure of columns against the first one, t or z.
struct Plan {
  std::string name, caption, label;
  std::vector<Label> columns;
  bool log = false;
  bool inside = false;  // a ratio, of which nothing is left but noise above the surface and below the base
};

const std::vector<Plan>& series_plans() {
  static const std::vector<Plan> plans{
      {"energy",
       "Energies in time.",
       "energy",
       {{"e_translational", "translation"},
        {"e_rotational", "rotation"},
        {"e_normal_spring", "normal springs"},
        {"e_tangential_spring", "tangential springs"}},
       true},
      {"energy_ratio",
       "Kinetic over elastic energy. It falls below 1e-5 in a flow that has arrested, becomes constant in a steady "
       "one, and "
       "keeps growing in one that accelerates (Weinhart et al. 2012, figure 3).",
       "E_{kin} / E_{ela}",
       {{"energy_ratio", ""}},
       true},
      {"mean_velocity", "Mean downslope velocity of the flowing grains in time.", "mean u_x", {{"u_x", ""}}, false},
      {"ledger",
       "Energy now, plus what was lost, minus energy at the start: zero but for the error of the integration.",
       "residual",
       {{"ledger_residual", ""}},
       false},
      {"front", "Lower and upper end of the layer in time.", "x", {{"front", "front"}, {"tail", "tail"}}, false},
      {"largest_thickness", "Largest thickness in time.", "largest h", {{"h_max", ""}}, false},
      {"largest_speed", "Largest speed in time.", "largest speed", {{"speed_max", ""}}, false},
      {"kinetic_energy", "Kinetic energy of the layer in time.", "kinetic energy", {{"kinetic_energy", ""}}, false},
      {"mass_balance",
       "Mass in the domain, plus what has left, minus what there was, over the mass: zero but for round-off.",
       "relative error",
       {{"mass_error_rel", ""}},
       false}};
  return plans;
}

const std::vector<Plan>& profile_plans() {
  static const std::vector<Plan> plans{
      {"velocity",
       "Downslope velocity over the depth. Dashed: Bagnold's profile with the same mean velocity and height.",
       "u_x",
       {{"u_x", ""}},
       false},
      {"solid_fraction", "Solid fraction over the depth.", "solid fraction", {{"phi", ""}}, false},
      {"stress",
       "Stresses over the depth, compression positive. Dashed: the weight of what is above, which is the normal stress "
       "of a "
       "steady flow.",
       "stress",
       {{"sigma_xx", "xx"}, {"sigma_yy", "yy"}, {"sigma_zz", "zz"}, {"sigma_xz", "-xz"}},
       false},
      {"friction",
       "Friction: shear stress over normal stress. In a steady flow it is the tangent of the slope (dashed).",
       "{/Symbol m}",
       {{"mu", ""}},
       false,
       true},
      {"inertial_number", "Inertial number over the depth.", "I", {{"inertial_number", ""}}, false, true},
      {"temperature", "Granular temperature over the depth.", "T", {{"temperature", ""}}, false}};
  return plans;
}

std::string legend(const RunData& run, const std::string& label, bool several) {
  if (!several) return label;
  return label.empty() ? run.name : run.name + ": " + label;
}

// At most about `most` of the values, evenly taken, the last always among them: a figure has no room for more.
std::vector<double> thinned(const std::vector<double>& values, std::size_t most = 2000) {
  const std::size_t stride = std::max<std::size_t>(1, values.size() / most);
  std::vector<double> kept;
  for (std::size_t k = 0; k < values.size(); k += stride) kept.push_back(values[k]);
  if (!values.empty() && (values.size() - 1) % stride != 0) kept.push_back(values.back());
  return kept;
}

bool worth_drawing(const Curve& curve) {
  return std::any_of(curve.y.begin(), curve.y.end(), [](double v) { return std::isfinite(v); }) &&
         std::any_of(curve.x.begin(), curve.x.end(), [](double v) { return std::isfinite(v); });
}

// z upwards, the quantity across; `inside` the flow only, where that is known.
Curve over_depth(const RunData& run, const io::CsvTable& profile, const std::string& column, std::string label,
                 bool inside) {
  Curve curve{.label = std::move(label), .x = profile[column], .y = profile["z"]};
  if (column == "sigma_xz")  // negative in a flow along x: drawn with the others as its opposite
    for (double& v : curve.x) v = -v;
  const double h = number(run, "flow", "h"), base = number(run, "flow", "base");
  if (inside && std::isfinite(h * base))
    for (std::size_t k = 0; k < curve.x.size(); ++k)
      if (curve.y[k] < base || curve.y[k] > base + h) curve.x[k] = NAN;
  return curve;
}

// u = (5/3) u_bar (1 - ((h - z)/h)^(3/2)) with z from the base (Weinhart et al. 2012, section 7).
std::optional<Curve> bagnold_profile(const RunData& run, bool several) {
  const double h = number(run, "flow", "h"), base = number(run, "flow", "base"), mean = number(run, "flow", "u_bar");
  if (!std::isfinite(h * base * mean)) return std::nullopt;
  Curve curve{.label = legend(run, "Bagnold", several), .x = {}, .y = {}, .stroke = Stroke::dashed};
  constexpr int points = 100;
  for (int k = 0; k <= points; ++k) {
    const double z = h * k / points;
    curve.x.push_back(5.0 / 3.0 * mean * (1 - std::pow((h - z) / h, 1.5)));
    curve.y.push_back(base + z);
  }
  return curve;
}

// The weight per area above z: integral of rho g cos(theta), with g cos(theta) from the summary.
std::optional<Curve> weight_above(const RunData& run, bool several) {
  const auto& profile = *run.profile;
  const double g = number(run, "flow", "gravity_normal");
  if (!profile.has("rho") || profile.rows() < 2 || !std::isfinite(g)) return std::nullopt;
  const auto &z = profile["z"], &rho = profile["rho"];
  std::vector<double> weight(z.size(), 0.0);
  for (std::size_t k = z.size() - 1; k-- > 0;)
    weight[k] = weight[k + 1] + 0.5 * g * (rho[k] + rho[k + 1]) * (z[k + 1] - z[k]);
  return Curve{.label = legend(run, "weight above", several), .x = weight, .y = z, .stroke = Stroke::dashed};
}

std::optional<Curve> slope(const RunData& run, bool several) {
  const double theta = number(run, "flow", "theta_deg");
  if (!std::isfinite(theta)) return std::nullopt;
  const double mu = std::tan(theta * M_PI / 180);
  const double h = number(run, "flow", "h"), base = number(run, "flow", "base");
  const auto& z = (*run.profile)["z"];
  const auto [low, high] = std::minmax_element(z.begin(), z.end());
  std::vector<double> ends{*low, *high};
  if (std::isfinite(h * base)) ends = {base, base + h};
  return Curve{.label = legend(run, "tan {/Symbol q}", several), .x = {mu, mu}, .y = ends, .stroke = Stroke::dashed};
}

void keep(std::vector<Figure>& all, Figure figure) {
  std::erase_if(figure.curves, [](const Curve& curve) { return !worth_drawing(curve); });
  if (!figure.curves.empty()) all.push_back(std::move(figure));
}

void add_series(std::vector<Figure>& all, std::span<const RunData> runs) {
  const bool several = runs.size() > 1;
  const std::size_t before = all.size();
  const auto figure_of = [&](const Plan& plan) {
    Figure figure{plan.name, plan.caption, "t", plan.label, false, plan.log, {}};
    for (const auto& run : runs) {
      if (!run.series || run.series->names.empty()) continue;
      for (const auto& [column, label] : plan.columns)
        if (run.series->has(column))
          figure.curves.push_back(
              {legend(run, label, several), thinned(run.series->cells[0]), thinned((*run.series)[column])});
    }
    if (plan.log)
      for (auto& curve : figure.curves)
        for (double& y : curve.y)
          if (y <= 0) y = NAN;  // no place on a logarithmic axis
    return figure;
  };
  for (const auto& plan : series_plans()) keep(all, figure_of(plan));
  if (all.size() > before) return;
  for (const auto& run : runs)
    if (run.series)
      for (const auto& column : run.series->names)
        if (column != run.series->names[0] &&
            std::none_of(all.begin(), all.end(), [&](const Figure& f) { return f.name == column; }))
          keep(all, figure_of({column, column + " in time.", column, {{column, ""}}, false}));
}

// gauge0_h, gauge1_h, ...: as many columns as the case has observers.
void add_numbered(std::vector<Figure>& all, std::span<const RunData> runs) {
  struct Family {
    std::string name, begin, end, caption, label;
  };
  const Family families[] = {
      {"gauge_thickness", "gauge", "_h", "Thickness at the gauges in time.", "h"},
      {"gauge_speed", "gauge", "_speed", "Speed at the gauges in time.", "speed"},
      {"discharge", "section", "_discharge", "Volume per time through the cross-sections.", "discharge"}};
  for (const Family& family : families) {
    Figure figure{family.name, family.caption, "t", family.label, false, false, {}};
    for (const auto& run : runs) {
      if (!run.series || run.series->names.empty()) continue;
      for (const auto& column : run.series->names)
        if (column.starts_with(family.begin) && column.ends_with(family.end))
          figure.curves.push_back({legend(run, column.substr(0, column.size() - family.end.size()), runs.size() > 1),
                                   thinned(run.series->cells[0]), thinned((*run.series)[column])});
    }
    keep(all, std::move(figure));
  }
}

void add_profiles(std::vector<Figure>& all, std::span<const RunData> runs) {
  const bool several = runs.size() > 1;
  for (const auto& plan : profile_plans()) {
    Figure figure{plan.name, plan.caption, plan.label, "z", false, false, {}};
    for (const auto& run : runs) {
      if (!run.profile || !run.profile->has("z")) continue;
      for (const auto& [column, label] : plan.columns)
        if (run.profile->has(column))
          figure.curves.push_back(over_depth(run, *run.profile, column, legend(run, label, several), plan.inside));
      if (figure.curves.empty()) continue;
      std::optional<Curve> reference;
      if (plan.name == "velocity") reference = bagnold_profile(run, several);
      if (plan.name == "stress") reference = weight_above(run, several);
      if (plan.name == "friction") reference = slope(run, several);
      if (reference) figure.curves.push_back(*std::move(reference));
    }
    keep(all, std::move(figure));
  }
}

// Figure 14: the rate of strain in units of the mean one, over the depth in units of the height, and Bagnold's,
// (5/2) (1 - z/h)^(1/2).
void add_strain(std::vector<Figure>& all, std::span<const RunData> runs) {
  Figure figure{
      "strain",
      "Rate of strain over its depth average, (h/u) du/dz, against height over flow height. Dashed: Bagnold's "
      "profile (Weinhart et al. 2012, figure 14).",
      "(h/u) du/dz",
      "(z - b)/h",
      false,
      false,
      {}};
  for (const auto& run : runs) {
    const double h = number(run, "flow", "h"), base = number(run, "flow", "base"), mean = number(run, "flow", "u_bar");
    if (!run.profile || !run.profile->has("grad_u_xz") || !std::isfinite(h * base / mean)) continue;
    const auto &z = (*run.profile)["z"], &rate = (*run.profile)["grad_u_xz"];
    Curve curve{.label = legend(run, "", runs.size() > 1), .x = {}, .y = {}};
    for (std::size_t k = 0; k < z.size(); ++k) {
      if (z[k] < base || z[k] > base + h) continue;
      curve.x.push_back(h / mean * rate[k]);
      curve.y.push_back((z[k] - base) / h);
    }
    figure.curves.push_back(std::move(curve));
  }
  if (figure.curves.empty()) return;
  Curve reference{.label = "Bagnold", .x = {}, .y = {}, .stroke = Stroke::dashed};
  for (int k = 0; k <= 100; ++k) {
    reference.x.push_back(2.5 * std::sqrt(1 - 0.01 * k));
    reference.y.push_back(0.01 * k);
  }
  figure.curves.push_back(std::move(reference));
  keep(all, std::move(figure));
}

void add_widths(std::vector<Figure>& all, std::span<const RunData> runs) {
  Figure figure{"widths",
                "Solid fraction for several widths of the kernel, in grain diameters: narrow ones show the layers of "
                "grains, wide "
                "ones smear base and surface (Weinhart et al. 2012, figure 6).",
                "solid fraction",
                "z",
                false,
                false,
                {}};
  for (const auto& run : runs) {
    if (!run.widths || !run.widths->has("z")) continue;
    for (const auto& column : run.widths->names)
      if (column.starts_with("phi_w"))
        figure.curves.push_back(
            over_depth(run, *run.widths, column, legend(run, "w = " + column.substr(5), runs.size() > 1), false));
  }
  keep(all, std::move(figure));
}

void add_steadiness(std::vector<Figure>& all, std::span<const RunData> runs) {
  Figure figure{
      "steadiness",
      "Rate of change of momentum left in the average over a time T, over the weight. In a steady flow it falls like "
      "1/T (Weinhart et al. 2012, figure 5).",
      "T",
      "residual",
      true,
      true,
      {}};
  for (const auto& run : runs)
    if (run.steadiness)
      figure.curves.push_back(
          {legend(run, "", runs.size() > 1), (*run.steadiness)["duration"], (*run.steadiness)["residual"]});
  keep(all, std::move(figure));
}

}  // namespace

std::vector<Figure> figures(std::span<const RunData> runs) {
  std::vector<Figure> all;
  if (auto continuum = continuum_figures(runs); !continuum.empty()) return continuum;
  add_profiles(all, runs);
  add_strain(all, runs);
  add_widths(all, runs);
  add_steadiness(all, runs);
  add_series(all, runs);
  add_numbered(all, runs);
  return all;
}

void draw(const Figure& figure, const std::filesystem::path& file) {
  std::string script = std::string(axes_style) + "set key outside top center horizontal\n";
  script += fmt::format("set xlabel {}\nset ylabel {}\n", in_quotes(figure.x_label), in_quotes(figure.y_label));
  if (figure.log_x) script += "set logscale x\n";
  if (figure.log_y) script += "set logscale y\nset format y '10^{%T}'\n";
  std::vector<io::PlotData> data;
  std::string plots;
  int color = 0;
  for (const auto& curve : figure.curves) {
    const auto name = fmt::format("curve{}", data.size());
    data.push_back({name, {curve.x, curve.y}});
    if (curve.stroke != Stroke::dashed || color == 0) ++color;  // a dashed reference has the colour of its curve
    const std::string style = curve.stroke == Stroke::points   ? "with points pt 7 ps 0.4"
                              : curve.stroke == Stroke::dashed ? "with lines dt 2 lw 1.5"
                                                               : "with lines lw 2";
    plots += fmt::format("{}${} using 1:2 {} lt {} {}", plots.empty() ? "plot " : ", ", name, style, color,
                         curve.label.empty() ? "notitle"
                                             : "title " + in_quotes(curve.label) +
                                                   (curve.label.find("{/") == std::string::npos ? " noenhanced" : ""));
  }
  io::plot(file, script + plots, data);
}

}  // namespace bagnold::report

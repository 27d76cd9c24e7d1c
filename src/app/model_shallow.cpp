// The shallow-layer model as the driver sees it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/model.hpp"
#include "app/shallow_maps.hpp"
#include "app/signals.hpp"

namespace bagnold::app {

namespace {

class ShallowModel final : public Model {
 public:
  explicit ShallowModel(ShallowKeys keys) : keys_(std::move(keys)) {}

  void build(const Building&) override {
    in_ = build_shallow(keys_);
    initial_mass_ = shallow::total_mass(in_.solver, in_.state);
    start_maps(in_, maps_);
  }

  std::string_view scenario() const override { return keys_.scenario; }
  double time() const override { return in_.state.time; }
  double end_time() const override { return keys_.time.end; }
  std::int64_t step() const override { return in_.state.step; }
  double element_steps() const override { return in_.state.cell_updates - updates_before_; }

  void advance(double until) override {
    while (in_.state.time < until * (1 - 1e-12) && !ended() && !stop_requested()) {
      shallow::advance_one_step(in_.solver, in_.state, in_.end);
      observe(in_, maps_);
      watch_end();
    }
  }
  bool ended() const override { return in_.stop_when_arrested && (arrested_ >= steps_at_rest || all_left()); }
  std::string status() const override { return arrested_ >= steps_at_rest ? "arrested" : "completed"; }

  std::vector<NamedArray> state() override {
    auto arrays = shallow::state_arrays(in_.state);
    for (const NamedArray& a : map_arrays(maps_)) arrays.push_back(a);
    arrays.push_back({"initial_mass", &initial_mass_});
    arrays.push_back({"arrested", &arrested_});
    arrays.push_back({"all_left_at", &all_left_at_});
    return arrays;
  }
  void restored() override {
    shallow::refresh(in_.solver, in_.state);
    look(in_, maps_);
    updates_before_ = in_.state.cell_updates;
  }

  std::vector<io::Column> series_columns() const override { return shallow_series_columns(in_); }
  std::vector<double> series_row() override {
    look(in_, maps_);
    return shallow_series_row(in_, maps_, initial_mass_);
  }
  std::string progress() override {
    const auto row = series_row();
    return fmt::format("front {:.4g}, h {:.3g}, speed {:.3g}", row[4], row[6], row[7]);
  }

  void write_snapshot(io::H5File& file, const std::string& group) override {
    look(in_, maps_);
    write_shallow_snapshot(file, group, in_, maps_);
  }
  std::vector<std::pair<std::string, std::string>> write_vtk(const std::filesystem::path& directory,
                                                             int number) override {
    const std::string name = fmt::format("layer_{:06}.vti", number);
    look(in_, maps_);
    write_shallow_vti(directory / name, in_, maps_);
    return {{"layer", name}};
  }
  void write_results(const std::filesystem::path& directory) override {
    look(in_, maps_);
    write_shallow_results(directory, in_, maps_);
  }

  void add_summary(nlohmann::ordered_json& summary, double wall_s) override {
    const auto row = series_row();
    const auto number = [](double v) {
      return std::isfinite(v) ? nlohmann::ordered_json(v) : nlohmann::ordered_json(nullptr);
    };
    const shallow::Grid& g = in_.solver.setup.grid;
    summary["cells"] = static_cast<std::int64_t>(g.nx) * g.ny;
    summary["cell_updates_per_s"] = number(wall_s > 0 ? element_steps() / wall_s : NAN);
    summary["mass_error_rel"] = std::abs(row[3]);
    summary["min_h"] = maps_.smallest_h;
    summary["max_h"] = maps_.largest_h;
    summary["dt_min"] = in_.state.smallest_step;
    summary["closure"] = in_.solver.closure.set.name;
    summary["front"] = number(row[4]);
    summary["tail"] = number(row[5]);
    summary["mass"] = row[1];
    summary["mass_out"] = row[2];
    summary["all_left_at"] = number(all_left_at_);
    summary["max_speed"] = *std::max_element(maps_.max_speed.begin(), maps_.max_speed.end());
    double used = 0, outside = 0;
    for (std::size_t k = 0; k < maps_.max_h.size(); ++k) {
      used += maps_.max_h[k] > in_.impact_depth ? 1 : 0;
      outside += maps_.max_h[k] > in_.impact_depth ? maps_.outside[k] : 0;
    }
    summary["outside_validity_fraction"] = number(used > 0 ? outside / used : NAN);
  }

  std::vector<Derived> derived() override {
    const shallow::Solver& s = in_.solver;
    const shallow::Grid& g = s.setup.grid;
    const double c = fastest_at_start(), dt = s.setup.scheme.cfl * g.dx / c;
    return {{"cells", fmt::format("{} x {}", g.nx, g.ny), "grid"},
            {"cell size", fmt::format("{:.4g} x {:.4g}", g.dx, g.dy), "length"},
            {"mass", fmt::format("{:.6g}", initial_mass_), "in the domain at the start"},
            {"dry depth", fmt::format("{:.4g}", s.setup.scheme.dry_depth),
             fmt::format("thinner layers neither move nor push; {:.2g} of the largest thickness, {:.4g}",
                         s.setup.scheme.dry_depth / in_.largest_thickness, in_.largest_thickness)},
            {"wave speed", fmt::format("{:.4g}", c),
             "largest |u| + sqrt(K g cos(theta) h), of what is there and of what flows in"},
            {"first step", c > 0 ? fmt::format("{:.3g}", dt) : "none", "about; cfl dx/wave speed"},
            {"closure", s.closure.set.name, s.closure.set.source}};
  }

  // Only wet cells are stepped, at steps that shorten as the layer gets faster: twice as many as at the first step.
  Cost cost() override {
    const shallow::Grid& g = in_.solver.setup.grid;
    const double cells = static_cast<double>(g.nx) * g.ny, c = fastest_at_start();
    const double dt = std::min(in_.solver.setup.scheme.cfl * std::min(g.dx, g.two_d() ? g.dy : g.dx) / c,
                               in_.solver.setup.scheme.max_step);
    return {.elements = "cell",
            .engine = g.two_d() ? "2D" : "1D",
            .count = cells,
            .element_steps = c > 0 ? 2 * cells * in_.end / dt * wet_share() : NAN,
            .usual_speed = 1e7,
            .memory_mb = cells * 400e-6,
            .snapshot_mb = cells * (g.two_d() ? 64e-6 : 40e-6),
            .vtk_mb = cells * 130e-6,
            .checkpoint_mb = cells * 100e-6};
  }

 private:
  double fastest_at_start() const {
    const shallow::Solver& s = in_.solver;
    const auto speed = [&](double h, double u) { return std::abs(u) + std::sqrt(s.closure.K * s.closure.normal * h); };
    double fastest = 0;
    for (std::size_t k = 0; k < maps_.h.size(); ++k)
      if (maps_.h[k] > 0) fastest = std::max(fastest, speed(maps_.h[k], std::hypot(maps_.u[k], maps_.v[k])));
    for (const shallow::Boundary& b : s.setup.boundary)
      for (std::size_t k = 0; k < b.inflow.h.size(); ++k)
        fastest = std::max(fastest, speed(b.inflow.h[k], b.inflow.u[std::min(k, b.inflow.u.size() - 1)]));
    return fastest;
  }
  // Of the cells, in the mean over a run: those wet at the start and half of the others.
  double wet_share() const {
    double wet = 0;
    for (const double h : maps_.h) wet += h > in_.solver.setup.scheme.dry_depth ? 1 : 0;
    return 0.5 * (1 + wet / static_cast<double>(maps_.h.size()));
  }

  static constexpr std::int64_t steps_at_rest = 10;  // in a row, before the run counts as over

  bool all_left() const { return !std::isnan(all_left_at_); }
  // Nothing can happen any more where nothing is to come and everything rests, or nothing is thick enough to move.
  void watch_end() {
    const bool over = !shallow::more_to_come(in_.solver, in_.state.time), dry = shallow::is_dry(in_.solver);
    if (over && dry && !all_left()) all_left_at_ = in_.state.time;
    arrested_ = over && !dry && shallow::at_rest(in_.solver, in_.state) ? arrested_ + 1 : 0;
  }

  ShallowKeys keys_;
  ShallowInput in_;
  ShallowMaps maps_;
  double initial_mass_ = 0, updates_before_ = 0;
  double all_left_at_ = std::numeric_limits<double>::quiet_NaN();
  std::int64_t arrested_ = 0;
};

}  // namespace

std::unique_ptr<Model> make_shallow(config::Case& input) { return std::make_unique<ShallowModel>(read_shallow(input)); }

}  // namespace bagnold::app

// The particle model as the driver sees it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/dem_flow.hpp"
#include "app/dem_input.hpp"
#include "app/dem_output.hpp"
#include "app/model.hpp"
#include "app/signals.hpp"
#include "dem/contacts.hpp"
#include "dem/observe.hpp"

namespace bagnold::app {

namespace {

class DemModel final : public Model {
 public:
  explicit DemModel(DemKeys keys) : keys_(std::move(keys)) {}

  void build(const Building& how) override {
    in_ = build_dem(keys_, how);
    for (const std::string& warning : in_.warnings) fmt::print(stderr, "warning: {}\n", warning);
    if (in_.scenario == "chute") flow_.emplace(keys_.input->root().child("cg"), in_);
    if (in_.gravity > 0) {
      const double unit = std::sqrt(in_.diameter / in_.gravity);
      arrest_check_ = std::max<std::int64_t>(1, std::llround(0.5 * unit / in_.state.dt));
      arrest_from_ = 10 * unit;
    }
    if (!how.estimate) initial_energy_ = dem::energies(in_.state, in_.laws).total();
  }

  std::string_view scenario() const override { return keys_.scenario; }
  double time() const override { return in_.state.time(); }
  double end_time() const override { return keys_.time.end; }
  std::int64_t step() const override { return in_.state.step; }
  double element_steps() const override { return grain_steps_; }

  void advance(double until) override {
    const double goal =
        until * (1 - 1e-12);  // what the driver takes for `until`: it would wait forever for anything less
    const auto last = static_cast<std::int64_t>(std::ceil(goal / in_.state.dt));
    // Signals are heeded every few tenths of a second.
    const std::int64_t chunk =
        std::max<std::int64_t>(1, 20'000'000 / std::max<std::int64_t>(1, in_.state.grains.flowing));
    while (time() < goal && !ended() && !stop_requested()) {
      std::int64_t steps = std::clamp<std::int64_t>(last - in_.state.step, 1, chunk);
      if (arrest_check_ > 0) steps = std::min(steps, arrest_check_ - in_.state.step % arrest_check_);
      if (flow_) steps = std::min(steps, flow_->next_step(in_.state.step) - in_.state.step);
      dem::advance_inside(in_.state, in_.laws, steps, flow_ ? flow_->watch(in_) : dem::Watch{});
      if (flow_) flow_->observe(in_);
      grain_steps_ += static_cast<double>(steps * in_.state.grains.flowing);
      if (arrest_check_ > 0 && in_.state.step % arrest_check_ == 0 && time() > arrest_from_) check_arrest();
    }
  }

  bool ended() const override { return in_.stop_when_arrested && arrested_ != 0; }
  std::string status() const override { return arrested_ != 0 ? "arrested" : "completed"; }

  std::vector<NamedArray> state() override {
    auto arrays = dem::named_arrays(complete().state);
    for (NamedArray& a : arrays) a.name = "dem/" + a.name;
    arrays.push_back({"arrested", &arrested_});
    arrays.push_back({"initial_energy", &initial_energy_});
    if (flow_)
      for (NamedArray& a : flow_->state()) arrays.push_back(std::move(a));
    return arrays;
  }
  void restored() override {}

  std::vector<io::Column> series_columns() const override { return dem_series_columns(); }
  std::vector<double> series_row() override { return dem_series_row(in_, seen(), initial_energy_); }

  std::string progress() override {
    const dem::Energies e = seen().energies;
    if (in_.gravity == 0 || e.elastic() == 0) return fmt::format("E_kin {:.4g}", e.kinetic());
    return fmt::format("E_kin/E_ela {:.3g}", e.kinetic() / e.elastic());
  }

  void write_origin(io::H5File& file) override {
    for (const auto& [name, bed] : in_.beds) write_bed(file, name, bed);
  }
  void write_snapshot(io::H5File& file, const std::string& group) override {
    dem::list_contacts(complete().state, in_.laws, contacts_);
    write_dem_snapshot(file, group, in_.state, contacts_);
  }
  std::vector<std::pair<std::string, std::string>> write_vtk(const std::filesystem::path& directory,
                                                             int number) override {
    dem::list_contacts(complete().state, in_.laws, contacts_);
    return write_dem_vtk(directory, number, in_.state, contacts_);
  }
  void write_results(const std::filesystem::path& directory) override {
    if (flow_) flow_->write(directory, complete());
  }

  void add_summary(nlohmann::ordered_json& summary, double wall_s) override {
    summary["grains"] = in_.state.grains.flowing;
    summary["base_grains"] = in_.state.grains.size() - in_.state.grains.flowing;
    summary["particle_steps_per_s"] = wall_s > 0 ? grain_steps_ / wall_s : NAN;
    summary["list_rebuilds"] = in_.state.rebuilds;
    if (!in_.beds.empty()) summary["bed_hash"] = in_.bed_hash;
    const dem::Observation last = seen();
    add_dem_summary(summary, complete(), last, initial_energy_);
    if (flow_) flow_->add_summary(summary, in_);
  }

  std::vector<Derived> derived() override { return dem_derived(in_); }
  Cost cost() override { return dem_cost(in_); }

 private:
  // The engine keeps the grains from step to step and is only asked; whoever needs them all completes the state.
  dem::Observation seen() { return dem::observe(in_.state, in_.laws); }
  DemInput& complete() {
    dem::hand_back(in_.state);
    return in_;
  }

  void check_arrest() {
    const dem::Energies e = seen().energies;
    arrested_ = e.kinetic() < 1e-5 * e.elastic() ? 1 : 0;  // Weinhart et al. 2012, section 6
  }

  DemKeys keys_;
  DemInput in_;
  std::optional<DemFlow> flow_;  // of flows that are periodic in x and y
  double initial_energy_ = 0;
  std::int64_t arrested_ = 0, arrest_check_ = 0;  // steps between checks; 0: none
  double arrest_from_ = 0;
  double grain_steps_ = 0;
  std::vector<dem::Contact> contacts_;  // scratch
};

}  // namespace

std::unique_ptr<Model> make_dem(config::Case& input) { return std::make_unique<DemModel>(read_dem(input)); }

}  // namespace bagnold::app

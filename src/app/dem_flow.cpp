#include "app/dem_flow.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/profile_files.hpp"
#include "dem/observe.hpp"

namespace bagnold::app {

namespace {

double time_unit(const DemInput& in) { return in.gravity > 0 ? std::sqrt(in.diameter / in.gravity) : in.end / 1000; }

cg::StreamingOptions read_options(const config::Section& section, const DemInput& in) {
  CgKeys keys = section.read<CgKeys>();
  const auto settle = [&](std::optional<double>& value, const char* key, double automatic) {
    if (!value) value = automatic;
    section.resolve(key, *value);
  };
  settle(keys.width, "width", 0.25 * in.diameter);
  settle(keys.spacing, "spacing", 0.25 * *keys.width);
  settle(keys.until, "until", in.end);
  settle(keys.from, "from", std::max(0.5 * *keys.until, *keys.until - 100 * time_unit(in)));
  double shortest = INFINITY;
  for (const dem::ContactType& type : dem::contact_types(in.state, in.model)) shortest = std::min(shortest, type.tc);
  settle(keys.every, "every", 0.5 * shortest);
  if (*keys.from > *keys.until)
    section.fail("from", "the average begins after it ends (cg.until), expected from <= until");

  cg::StreamingOptions options;
  options.kernel = *laws::CgKernels::make(section.choose("kernel", "gaussian", laws::CgKernels::names()));
  std::visit([&](auto& kernel) { kernel.width = *keys.width; }, options.kernel);
  options.spacing = *keys.spacing;
  options.every = std::max<std::int64_t>(1, std::llround(*keys.every / in.state.dt));
  options.first_step = std::llround(*keys.from / in.state.dt);
  options.last_step = std::llround(*keys.until / in.state.dt);
  return options;
}

cg::FlowSetting setting_of(const DemInput& in) { return {in.state.gravity, in.diameter}; }

}  // namespace

void DemFlow::read(const config::Section& cg) {
  (void)cg.read<CgKeys>();
  (void)cg.choose("kernel", "gaussian", laws::CgKernels::names());
}

DemFlow::DemFlow(const config::Section& section, const DemInput& in)
    : options_(read_options(section, in)),
      observer_(options_, in.state.box),
      energy_every_(std::max<std::int64_t>(1, std::llround(0.5 * time_unit(in) / in.state.dt))) {}

std::int64_t DemFlow::next_step(std::int64_t step) const { return (step / energy_every_ + 1) * energy_every_; }

void DemFlow::observe(DemInput& in) {
  if (in.state.step % energy_every_ != 0 || in.state.step == last_energy_step_) return;
  const dem::Observation seen = dem::observe(in.state, in.laws);
  t_.push_back(in.state.time());
  kinetic_.push_back(seen.energies.kinetic());
  elastic_.push_back(seen.energies.elastic());
  max_overlap_ = std::max(max_overlap_, seen.overlap_ratio);
  last_energy_step_ = in.state.step;
}

std::vector<NamedArray> DemFlow::state() {
  auto arrays = observer_.state();
  arrays.push_back({"flow/t", &t_});
  arrays.push_back({"flow/kinetic", &kinetic_});
  arrays.push_back({"flow/elastic", &elastic_});
  arrays.push_back({"flow/max_overlap", &max_overlap_});
  arrays.push_back({"flow/last_energy_step", &last_energy_step_});
  return arrays;
}

cg::BlockedProfile DemFlow::profile(const DemInput& in) const {
  if (observer_.profile().samples() > 0) return observer_.profile();
  cg::BlockedProfile instant(options_.kernel, options_.spacing, in.state.box);
  cg::DemScratch scratch;
  instant.add(cg::snapshot_of(in.state, in.laws, scratch));
  return instant;
}

cg::RegimeReport DemFlow::regime(const cg::FlowNumbers& numbers) const {
  return cg::classify({t_, kinetic_, elastic_}, numbers.layering);
}

void DemFlow::write(const std::filesystem::path& directory, const DemInput& in) const {
  const cg::BlockedProfile all = profile(in);
  write_profile(directory / "profile.csv", all.mean());
  write_widths(directory / "widths.csv", all, in.diameter);
  write_steadiness(directory / "steadiness.csv", all, setting_of(in));
}

void DemFlow::add_summary(nlohmann::ordered_json& summary, const DemInput& in) const {
  const cg::BlockedProfile all = profile(in);
  const cg::FlowNumbers numbers = cg::analyse(all.mean(), setting_of(in)), errors = cg::errors(all, setting_of(in));
  nlohmann::ordered_json flow;
  add_regime(flow, regime(numbers));
  flow["theta_deg"] = in.angle_deg;
  flow["lambda"] = in.base_size_ratio;
  flow["fill_height"] = in.fill_height;
  flow["gravity_normal"] = -in.state.gravity.z;
  add_flow_numbers(flow, numbers, errors);
  flow["max_overlap_over_radius"] = max_overlap_;
  flow["base_grains"] = in.state.grains.size() - in.state.grains.flowing;
  flow["averaged_from"] = all.mean().begin;
  flow["averaged_until"] = all.mean().end;
  flow["samples"] = all.samples();
  summary["flow"] = flow;
}

}  // namespace bagnold::app

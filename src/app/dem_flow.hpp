// What a run of the particle model learns about a flow that is periodic in x and y: averaged profiles, the numbers of
// the flow, its regime (section [cg] of a case).
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <tuple>

#include "app/dem_input.hpp"
#include "cg/flow.hpp"
#include "cg/from_dem.hpp"
#include "cg/regime.hpp"

namespace bagnold::app {

// Keys of [cg]; the kernel's name is read beside them.
struct CgKeys {
  static constexpr std::string_view name = "cg";
  static constexpr std::string_view summary = "coarse-graining of depth profiles while the run goes on";
  std::optional<double> width, spacing, from, until, every;
  static constexpr auto fields() {
    return std::tuple{
        field("width", "length", "standard deviation of the kernel; auto: a quarter of the grain diameter",
              &CgKeys::width, positive()),
        field("spacing", "length", "distance of the nodes of a profile; auto: a quarter of the width", &CgKeys::spacing,
              positive()),
        field("from", "time", "first sample; auto: 100 sqrt(d/g) before `until`, at most half the run", &CgKeys::from,
              non_negative()),
        field("until", "time", "last sample; auto: the end", &CgKeys::until, non_negative()),
        field("every", "time", "between samples; auto: half the shortest collision time", &CgKeys::every, positive())};
  }
};

class DemFlow {
 public:
  static void read(const config::Section& cg);  // asks for every key of [cg] before there is anything to build from
  // From [cg] and what was built. Throws InputError at the place of a key that makes no sense.
  DemFlow(const config::Section& cg, const DemInput& in);

  dem::Watch watch(const DemInput& in) { return observer_.watch(in.laws); }  // for every step
  std::int64_t next_step(std::int64_t step) const;  // the next one at which observe() has to be called
  void observe(DemInput& in);
  std::vector<NamedArray> state();

  // profile.csv, widths.csv (solid fraction for several kernel widths), steadiness.csv. A run that ended before the average began
  // is described by its last instant.
  void write(const std::filesystem::path& directory, const DemInput& in) const;
  void add_summary(nlohmann::ordered_json& summary, const DemInput& in) const;

 private:
  cg::BlockedProfile profile(const DemInput& in) const;
  cg::RegimeReport regime(const cg::FlowNumbers& numbers) const;

  cg::StreamingOptions options_;
  cg::ProfileObserver observer_;
  std::int64_t energy_every_ = 1;              // steps
  std::vector<double> t_, kinetic_, elastic_;  // for the regime
  double max_overlap_ = 0;                     // over the radius, of the same instants
  std::int64_t last_energy_step_ = -1;
};

}  // namespace bagnold::app

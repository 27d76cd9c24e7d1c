// Carries a model from where it is to the end of its case, writing what the case asks for. Knows nothing of physics.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>

#include "app/model.hpp"
#include "core/fields.hpp"

namespace bagnold::config {
class Section;
}

namespace bagnold::app {

// [output]: intervals are in the case's unit of time; what is "auto" divides the whole run.
struct OutputSettings {
  static constexpr std::string_view name = "output";
  static constexpr std::string_view summary = "what is written during a run, and how often";
  std::optional<double> series_every, snapshot_every, vtk_every;
  double checkpoint_every_s = 120;
  static constexpr auto fields() {
    return std::tuple{field("series_every", "time", "interval of rows in series.csv; auto: 1/1000 of the run",
                            &OutputSettings::series_every, positive()),
                      field("snapshot_every", "time", "interval of states in run.h5; auto: 1/10 of the run",
                            &OutputSettings::snapshot_every, positive()),
                      field("vtk_every", "time", "interval of ParaView files; auto: 1/20 of the run",
                            &OutputSettings::vtk_every, positive()),
                      field("checkpoint_every_s", "s", "wall time between exact checkpoints",
                            &OutputSettings::checkpoint_every_s, positive())};
  }
};

// With "auto" replaced by what it amounts to, also in the resolved case.
OutputSettings read_output(const config::Section& output, double end);

struct RunContext {
  std::filesystem::path directory;
  OutputSettings output;
  std::string model_name;
  std::int64_t seed = 0;
  std::string resolved_case;  // provenance
  bool resume = false, quiet = false;
};

// The exit code of the contract: 0, 3 (numerical failure, last good state kept) or 75 (interrupted, checkpoint written).
int drive(Model& model, const RunContext& context);

}  // namespace bagnold::app

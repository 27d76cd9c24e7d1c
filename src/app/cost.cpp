#include "app/cost.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/bed_store.hpp"
#include "app/machine.hpp"
#include "app/progress.hpp"
#include "core/parallel.hpp"
#include "core/variant.hpp"
#include "io/files.hpp"
#include "io/json.hpp"

namespace bagnold::app {

namespace {

namespace fs = std::filesystem;

// Speed depends on the size by what the caches hold: classes of a factor of two.
int size_class(double count) { return static_cast<int>(std::floor(std::log2(std::max(1.0, count)))); }

std::string row_of(const Cost& cost, std::string_view model) {
  return fmt::format("{} {} {}", model, cost.engine, name(variant()));
}

nlohmann::json speeds() {
  try {
    if (!cache_folder().empty()) return io::read_json(cache_folder() / "speeds.json");
  } catch (const std::exception&) {  // none yet, or not readable: nothing is known
  }
  return nlohmann::json::object();
}

// Element-steps per second on so many threads: of the nearest size within a factor of four that has been run. With another
// number of threads speeds are taken to be in proportion.
std::optional<double> remembered_speed(const Cost& cost, std::string_view model) {
  const nlohmann::json all = speeds();
  const std::string row = row_of(cost, model);
  if (!all.contains(row) || !all[row].is_object()) return {};
  const int size = size_class(cost.count);
  for (const int step : {0, -1, 1, -2, 2}) {
    const std::string key = std::to_string(size + step);
    if (!all[row].contains(key)) continue;
    const auto& entry = all[row][key];
    if (!entry.is_object() || !entry.contains("per_s") || !entry.contains("threads")) continue;
    const double speed = entry["per_s"].is_number() ? entry["per_s"].get<double>() : 0;
    const double team = entry["threads"].is_number() ? entry["threads"].get<double>() : 0;
    if (speed > 0 && team > 0) return speed * threads() / team;
  }
  return {};
}

}  // namespace

std::string time_text(const Cost& cost, std::string_view model) {
  if (!std::isfinite(cost.element_steps)) return "unknown: nothing moves at the start";
  const auto measured = remembered_speed(cost, model);
  const double speed = measured.value_or(cost.usual_speed * threads());
  return fmt::format("about {} ({:.2g} {}-steps/s, {})", duration_text(cost.element_steps / speed), speed,
                     cost.elements, measured ? "as lately here" : "assumed: no run of this size here yet");
}

std::vector<Derived> cost_lines(const Cost& cost, std::string_view model, const OutputSettings& output, double end) {
  const std::string about = cost.estimated ? "about " : "";
  const auto times = [&](const std::optional<double>& every) { return every ? std::floor(end / *every) + 2 : 0; };
  const double snapshots = times(output.snapshot_every), files = times(output.vtk_every);
  const double disk =
      snapshots * cost.snapshot_mb + files * cost.vtk_mb + 2 * cost.checkpoint_mb + times(output.series_every) * 250e-6;
  return {{cost.elements + "-steps",
           std::isfinite(cost.element_steps) ? about + fmt::format("{:.3g}", cost.element_steps) : "unknown",
           time_text(cost, model) + fmt::format(" on {} threads", threads())},
          {"memory", fmt::format("{:.0f} MB", 40 + cost.memory_mb), "about, 40 of them for the program"},
          {"disk", fmt::format("{:.1f} MB", disk),
           fmt::format("about: {:.0f} snapshots of {:.2g}, {:.0f} ParaView files of {:.2g}, checkpoints", snapshots,
                       cost.snapshot_mb, files, cost.vtk_mb)}};
}

void remember_speed(const Cost& cost, std::string_view model, double element_steps, double wall_s) {
  if (cache_folder().empty() || !(wall_s >= 2) || !(element_steps > 0)) return;
  nlohmann::json all = speeds();
  if (!all.is_object()) all = nlohmann::json::object();
  all[row_of(cost, model)][std::to_string(size_class(cost.count))] = {{"per_s", element_steps / wall_s},
                                                                      {"threads", threads()}};
  try {
    const fs::path file = cache_folder() / "speeds.json";
    const fs::path part = file.string() + fmt::format(".{}", ::getpid());  // other runs may be ending just now
    fs::create_directories(cache_folder());
    io::write_json(part, all);
    fs::rename(part, file);
  } catch (const std::exception&) {
  }
}

}  // namespace bagnold::app

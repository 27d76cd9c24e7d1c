#include "app/driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>

#include "app/machine.hpp"
#include "app/progress.hpp"
#include "app/signals.hpp"
#include "config/case.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/variant.hpp"
#include "core/version.hpp"
#include "io/checkpoint.hpp"
#include "io/csv.hpp"
#include "io/hdf5.hpp"
#include "io/json.hpp"
#include "io/vtk.hpp"

namespace bagnold::app {

namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Something that happens at t = 0, every, 2 every, ...; `next` counts what has been done and belongs to the checkpoint.
struct Schedule {
  double every = 1;
  std::int64_t next = 0;
  double due() const { return static_cast<double>(next) * every; }
};

// The run directory while the run goes on.
class Run {
 public:
  Run(Model& model, const RunContext& context)
      : model_(model),
        context_(context),
        provenance_(io::provenance(context.seed, context.resolved_case)),
        series_at_{*context.output.series_every},
        snapshot_at_{*context.output.snapshot_every},
        vtk_at_{*context.output.vtk_every} {
    if (context.resume) restore();
    const auto columns = model.series_columns();
    series_ = context.resume ? io::CsvWriter::resume(dir() / "series.csv", columns, model.time())
                             : io::CsvWriter::create(dir() / "series.csv", columns);
    if (!context.resume) {
      create_file();
      write_due();
      checkpoint();
    }
  }

  // The next moment something is due, or the end.
  double next_event() const {
    return std::min({series_at_.due(), snapshot_at_.due(), vtk_at_.due(), model_.end_time()});
  }

  // Everything due at the present time, and `also_last` at the end of a run whether due or not.
  void write_due(bool also_last = false) {
    const double now = model_.time() * (1 + 1e-12);
    const auto fire = [&](Schedule& schedule, auto&& action) {
      const bool due = schedule.due() <= now;
      while (schedule.due() <= now) ++schedule.next;
      if (due || also_last) action();
    };
    fire(series_at_, [&] { series_->row(model_.series_row()); });
    fire(snapshot_at_, [&] { snapshot(); });
    fire(vtk_at_, [&] { vtk(); });
  }

  void checkpoint() {
    wall_s_ += seconds_since(segment_);
    cpu_s_ += cpu_seconds() - segment_cpu_;
    segment_ = Clock::now();
    segment_cpu_ = cpu_seconds();
    io::write_checkpoint(dir(), state(), provenance_);
  }
  double seconds_since_checkpoint() const { return seconds_since(segment_); }

  void finish(const std::string& status) {
    if (status != "interrupted" && status != "failed") model_.write_results(dir());
    nlohmann::ordered_json summary;
    summary["version"] = version();
    summary["git_hash"] = git_hash();
    summary["model"] = context_.model_name;
    summary["scenario"] = model_.scenario();
    summary["status"] = status;
    summary["seed"] = context_.seed;
    summary["threads"] = threads();
    summary["variant"] = name(variant());
    summary["wall_s"] = wall_s_ + seconds_since(segment_);
    summary["cpu_s"] = cpu_s_ + cpu_seconds() - segment_cpu_;
    summary["steps"] = model_.step();
    summary["time"] = model_.time();
    model_.add_summary(summary, seconds_since(start_));
    io::write_json(dir() / "summary.json", summary);
  }

 private:
  const std::filesystem::path& dir() const { return context_.directory; }

  // The model's state and the driver's own: what has been written, and how long it took.
  std::vector<NamedArray> state() {
    auto arrays = model_.state();
    arrays.push_back({"driver/series", &series_at_.next});
    arrays.push_back({"driver/snapshots", &snapshot_at_.next});
    arrays.push_back({"driver/vtk", &vtk_at_.next});
    arrays.push_back({"driver/snapshot_number", &snapshot_number_});
    arrays.push_back({"driver/vtk_number", &vtk_number_});
    arrays.push_back({"driver/wall_s", &wall_s_});
    arrays.push_back({"driver/cpu_s", &cpu_s_});
    return arrays;
  }

  void restore() {
    const auto from = io::read_checkpoint(dir(), state());
    if (from.previous) fmt::print(stderr, "warning: {}: using {}\n", from.damage, from.file.string());
    model_.restored();
    if (!std::filesystem::exists(dir() / "run.h5")) create_file();
  }

  void create_file() {
    auto file = io::H5File::create(dir() / "run.h5");
    io::write_provenance(file, provenance_);
    model_.write_origin(file);
    file.close();
  }

  void snapshot() {
    auto file = io::H5File::append(dir() / "run.h5");
    const std::string group = fmt::format("snapshots/{:06}", snapshot_number_++);
    if (file.exists(group)) file.remove(group);  // left by a run that was killed after its last checkpoint
    file.attribute(group, "t", model_.time());
    file.attribute(group, "step", model_.step());
    model_.write_snapshot(file, group);
    file.close();
  }

  void vtk() {
    std::filesystem::create_directories(dir() / "vtk");
    for (const auto& [name, file] : model_.write_vtk(dir() / "vtk", static_cast<int>(vtk_number_))) {
      const auto path = dir() / "vtk" / (name + ".pvd");
      if (!collections_.contains(name))
        collections_.emplace(
            name, context_.resume ? io::PvdSeries::resume(path, model_.time()) : io::PvdSeries::create(path));
      collections_.at(name).add(model_.time(), file);
    }
    ++vtk_number_;
  }

  Model& model_;
  const RunContext& context_;
  io::Provenance provenance_;
  Schedule series_at_, snapshot_at_, vtk_at_;
  std::int64_t snapshot_number_ = 0, vtk_number_ = 0;
  std::optional<io::CsvWriter> series_;
  std::map<std::string, io::PvdSeries> collections_;
  double wall_s_ = 0, cpu_s_ = 0;  // of the whole run up to the last checkpoint
  double segment_cpu_ = cpu_seconds();
  Clock::time_point start_ = Clock::now(), segment_ = Clock::now();
};

// Advances to `until` in pieces short enough to show progress and write checkpoints in wall time.
// `piece`: how long they are, in time of the model; the next call goes on with that.
void advance(Model& model, Run& run, Progress& progress, const RunContext& context, double until, double& piece) {
  static constexpr double piece_s = 0.2;
  while (model.time() < until * (1 - 1e-12) && !model.ended() && !stop_requested()) {
    const auto begin = Clock::now();
    const double from = model.time();
    if (!(from + piece > from * (1 + 1e-11))) piece = until - from;  // as after a cut at the moment of an output
    model.advance(std::min(until, from + piece));
    const double took = std::max(1e-9, seconds_since(begin));
    const double longer = std::max(model.time() - from, 1e-300) * std::clamp(piece_s / took, 0.5, 2.0);
    // One that had to end early says nothing of longer ones, unless it took too long.
    piece = model.time() < until * (1 - 1e-12) ? longer : std::max(longer, took < piece_s ? piece : 0.0);
    if (progress.due()) progress.show(model.time(), model.progress());
    // Not at `until` itself: what is due there has not been written yet.
    const bool between = model.time() < until * (1 - 1e-12);
    if (between && run.seconds_since_checkpoint() > context.output.checkpoint_every_s) run.checkpoint();
  }
}

}  // namespace

OutputSettings read_output(const config::Section& section, double end) {
  auto output = section.read<OutputSettings>();
  const auto settle = [&](std::optional<double>& every, const char* key, double parts) {
    if (!every) every = end / parts;
    section.resolve(key, *every);
  };
  settle(output.series_every, "series_every", 1000);
  settle(output.snapshot_every, "snapshot_every", 10);
  settle(output.vtk_every, "vtk_every", 20);
  return output;
}

int drive(Model& model, const RunContext& context) {
  catch_signals();
  Run run(model, context);
  Progress progress(model.time(), model.end_time(), context.quiet);
  double piece = (run.next_event() - model.time()) / 64;
  try {
    while (model.time() < model.end_time() * (1 - 1e-12) && !model.ended()) {
      advance(model, run, progress, context, run.next_event(), piece);
      if (stop_requested()) {
        run.checkpoint();
        run.finish("interrupted");
        return 75;
      }
      const bool last = model.time() >= model.end_time() * (1 - 1e-12) || model.ended();
      run.write_due(last);
      if (run.seconds_since_checkpoint() > context.output.checkpoint_every_s) run.checkpoint();
    }
  } catch (const NumericalError&) {
    run.finish("failed");  // the checkpoint on disk is the last good state
    throw;
  }
  run.checkpoint();
  progress.show(model.time(), model.progress());
  run.finish(model.status());
  return 0;
}

}  // namespace bagnold::app

// What `run`, `resume` and `check` need to know of an engine. One implementation per model: app/model_dem.cpp,
// app/model_sph.cpp, app/model_shallow.cpp; each reads its part of the case, builds the scenario, owns the state and its observers.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/arrays.hpp"
#include "io/columns.hpp"

namespace bagnold::config {
class Case;
}
namespace bagnold::io {
class H5File;
}

namespace bagnold::app {

// A line of `bagnold check`: a derived number and what it means.
struct Derived {
  std::string name, value, meaning;
};

// How build() is to go about what takes long.
struct Building {
  bool estimate = false;           // no steps, as for `check`: what steps decide is estimated, and derived() says so
  bool quiet = false;              // no progress
  std::filesystem::path resuming;  // the run whose parts are used again; empty: none
};

// What a run will take, for `check`.
struct Cost {
  std::string elements;      // "grains"
  std::string engine;        // speeds are remembered by model, engine and size
  double count = 0;          // of the elements that take part in a step
  double element_steps = 0;  // NaN: nobody can tell before
  double usual_speed = 0;    // element-steps per second and thread where none is remembered
  double memory_mb = 0;
  double snapshot_mb = 0, vtk_mb = 0, checkpoint_mb = 0;
  bool estimated = false;  // count is a guess
};

// A model is made from its part of the case, then built; only then all but scenario() and end_time() may be asked.
class Model {
 public:
  Model() = default;
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;
  virtual ~Model() = default;

  // The initial state, from what was read: everything that takes long. Throws InputError at the place of a key that
  // turns out to be wrong only now, and Interrupted.
  virtual void build(const Building& how) = 0;

  virtual std::string_view scenario() const = 0;
  virtual double time() const = 0;
  virtual double end_time() const = 0;
  virtual std::int64_t step() const = 0;
  virtual double element_steps() const = 0;  // grain-, particle- or cell-steps taken by this process so far

  // Steps until time() >= until (to within rounding), stop_requested() (app/signals.hpp) or ended(). Must take the
  // same steps however a run is cut into calls: never shorten a step to hit `until`.
  virtual void advance(double until) = 0;
  // The run is over before end_time(), for example because the flow has arrested; `status` is for summary.json.
  virtual bool ended() const { return false; }
  virtual std::string status() const { return "completed"; }

  // Everything an exact checkpoint holds, observers' accumulators included. After the arrays are overwritten by
  // a checkpoint, restored() rebuilds what is derived from them.
  virtual std::vector<NamedArray> state() = 0;
  virtual void restored() = 0;

  virtual std::vector<io::Column> series_columns() const = 0;  // first column: t
  virtual std::vector<double> series_row() = 0;                // must not change the trajectory
  virtual std::string progress() = 0;                          // the physics that matters, a few words

  virtual void write_origin(io::H5File&) {}  // once into run.h5: what the initial state was made of
  virtual void write_snapshot(io::H5File& file, const std::string& group) = 0;  // into run.h5
  // Files for ParaView of the present state; returns (series name, file name relative to `directory`).
  virtual std::vector<std::pair<std::string, std::string>> write_vtk(const std::filesystem::path& directory,
                                                                     int number) = 0;
  // Files written once at the end (profile.csv, rasters, ...).
  virtual void write_results(const std::filesystem::path& directory) = 0;
  // Adds what the contract wants of this model; `wall_s` is what this process spent, for speeds.
  virtual void add_summary(nlohmann::ordered_json& summary, double wall_s) = 0;
  virtual std::vector<Derived> derived() = 0;
  virtual Cost cost() = 0;
};

// Reads the part of the case that belongs to the model named in it, every key, and builds nothing. `input` must outlive
// the model.
std::unique_ptr<Model> make_model(config::Case& input);
std::unique_ptr<Model> make_dem(config::Case& input);
std::unique_ptr<Model> make_shallow(config::Case& input);
std::unique_ptr<Model> make_sph(config::Case& input);

}  // namespace bagnold::app

// A case of the particle model: read into keys, then built into a state that is ready to step.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "app/bed_store.hpp"
#include "app/model.hpp"
#include "config/case.hpp"
#include "dem/algorithm.hpp"
#include "dem/contact_model.hpp"
#include "dem/step_limit.hpp"
#include "scenario/granular.hpp"

namespace bagnold::app {

struct DemTime {
  static constexpr std::string_view name = "time";
  static constexpr std::string_view summary = "how long a run lasts and how finely it steps";
  double end = 0;
  std::optional<double> step;
  bool stop_when_arrested = true;
  static constexpr auto fields() {
    return std::tuple{
        required("end", "time", "when the run ends", &DemTime::end, positive()),
        field("step", "time", "auto: tc/50 of the lightest, stiffest pair that can meet", &DemTime::step, positive()),
        field("stop_when_arrested", "", "end earlier when everything is at rest (scenario grains: default false)",
              &DemTime::stop_when_arrested)};
  }
};

// Keys of [scenario] wherever something is cut from a settled bed.
struct BedKeys {
  static constexpr std::string_view name = "bed";
  static constexpr std::string_view summary = "the settled bed that a rough base or a column is cut from";
  std::string bed = "auto", bed_hash = "auto";
  static constexpr auto fields() {
    return std::tuple{
        field("bed", "", "a run.h5 or a file of the cache whose bed is used; auto: from the cache, or settled now",
              &BedKeys::bed),
        field("bed_hash", "", "refuse every other bed; auto: take what comes", &BedKeys::bed_hash)};
  }
};

// Grains and planes one by one.
struct SinglesKeys {
  scenario::Singles singles;
  std::vector<scenario::SingleGrain> grains;
  std::vector<scenario::SingleWall> walls;
};

// A case as written. Whoever reads it keeps the case.
struct DemKeys {
  config::Case* input = nullptr;
  std::string scenario;
  std::variant<scenario::Chute, scenario::Avalanche, scenario::Column, scenario::Heap, SinglesKeys> setting;
  scenario::GrainMaterial material;
  dem::ContactModel contacts;
  DemTime time;
  BedKeys bed;  // the file relative to where the program runs
  std::uint64_t seed = 1;
  bool energy_ledger = false;
};

struct DemInput {
  std::string scenario;
  dem::DemState state;
  dem::ContactModel model;
  dem::ContactLaws laws;
  dem::StepLimit limit;  // the pair that decides the automatic step
  double end = 0;
  bool stop_when_arrested = false;
  double gravity = 0;                                          // magnitude
  double angle_deg = 0, base_size_ratio = 0, fill_height = 0;  // chute only
  double column_radius = 0, column_height = 0;                 // column and heap only
  double diameter = 1, density = 1;                            // of the mean flowing grain
  std::vector<std::pair<std::string, StoredBed>> beds;         // "base", "pile"
  std::string bed_hash;                                        // of all of them
  std::vector<scenario::BedRecipe> unsettled;  // not empty: beds stand in for these, and the state is a guess
  std::vector<std::string> warnings;
};

// The beds that a case needs, by name: "base", "pile".
std::vector<std::pair<std::string, scenario::BedRecipe>> bed_recipes(const DemKeys& keys);

// Both throw InputError at the place in the case of whatever is wrong or unphysical. What can be refused without a bed is
// refused before one is settled.
DemKeys read_dem(config::Case& input);
DemInput build_dem(const DemKeys& keys, const Building& how = {});

}  // namespace bagnold::app

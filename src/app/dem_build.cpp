// From the keys of a case of the particle model to a state: beds, grains, laws, step.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/dem_flow.hpp"
#include "app/dem_input.hpp"
#include "core/error.hpp"

namespace bagnold::app {

namespace {

using scenario::BedRecipe;

// A bed of the recipe from a file that somebody names. `mine`: it must be there.
std::optional<StoredBed> bed_from(const std::filesystem::path& path, const BedRecipe& recipe, bool must) {
  std::string why = "it holds no bed made with the numbers this case needs";
  try {
    for (StoredBed& stored : read_beds(path))
      if (stored.recipe == recipe) return std::move(stored);
  } catch (const IoError& error) {
    why = error.what();
  }
  if (must) throw UnphysicalError("scenario.bed", fmt::format("{}: {}", path.string(), why));
  return {};
}

// Without settling: from the file of the case, the run that is resumed, the cache.
std::optional<StoredBed> find_bed(const DemKeys& keys, const Building& how, const BedRecipe& recipe) {
  if (!how.resuming.empty())
    if (auto bed = bed_from(how.resuming / "run.h5", recipe, false)) return bed;
  if (keys.bed.bed != "auto") return bed_from(keys.bed.bed, recipe, true);
  return cached_bed(recipe);
}

std::string hash_of_all(const DemInput& in) {
  std::string all;
  for (const auto& [name, stored] : in.beds) all += (all.empty() ? "" : "+") + stored.hash;
  return all;
}

void expect_hash(const DemKeys& keys, const DemInput& in) {
  if (keys.bed.bed_hash == "auto" || keys.bed.bed_hash == in.bed_hash) return;
  throw UnphysicalError(
      "scenario.bed_hash",
      fmt::format("the case wants the bed {}, this one is {}; expected scenario.bed = the run.h5 of a "
                  "run on that bed, or scenario.bed_hash = \"auto\" to take this one",
                  keys.bed.bed_hash, in.bed_hash));
}

// Positions of base grains in their own diameters, if there is a base of grains.
std::vector<Vec3> base_of(const DemInput& in) {
  for (const auto& [name, stored] : in.beds)
    if (name == "base") return scenario::cut_base(stored.bed);
  return {};
}
const scenario::Bed& pile_of(const DemInput& in) { return in.beds.back().second.bed; }

struct MakeState {
  const DemKeys& keys;
  DemInput& out;
  dem::DemState operator()(const scenario::Chute& chute) const {
    out.angle_deg = chute.angle_deg;
    out.base_size_ratio = chute.base_size_ratio;
    out.fill_height = chute.fill_height;
    return scenario::make_chute(chute, keys.material, base_of(out), keys.seed);
  }
  dem::DemState operator()(const scenario::Avalanche& avalanche) const {
    return scenario::make_avalanche(avalanche, keys.material, base_of(out), pile_of(out));
  }
  dem::DemState operator()(const scenario::Column& column) const {
    out.column_radius = column.radius;
    out.column_height = column.height;
    return scenario::make_column(column, keys.material, base_of(out), pile_of(out));
  }
  dem::DemState operator()(const scenario::Heap& heap) const {
    out.column_radius = heap.radius;
    return scenario::make_heap(heap, keys.material, base_of(out), keys.seed);
  }
  dem::DemState operator()(const SinglesKeys& singles) const {
    return scenario::make_singles(singles.singles, singles.grains, singles.walls, keys.material);
  }
};

// That of the limiting pair; exactly collision_time/50 where that is the input.
double automatic_step(const DemInput& in) {
  if (const auto* linear = std::get_if<laws::Linear>(&in.model.pairs.front().normal))
    if (linear->collision_time && std::abs(*linear->collision_time / (50 * in.limit.step) - 1) < 1e-12)
      return *linear->collision_time / 50;
  return in.limit.step;
}

void report(const DemKeys& keys, const std::vector<dem::Finding>& findings, DemInput& out) {
  for (const dem::Finding& finding : findings) {
    if (finding.error) keys.input->fail(finding.key, finding.text);
    out.warnings.push_back(finding.key + ": " + finding.text);
  }
}

// Everything but the first evaluation of forces, from the beds in `out`.
void assemble(const DemKeys& keys, DemInput& out) {
  out.scenario = keys.scenario;
  out.model = keys.contacts;
  out.diameter = keys.material.diameter;
  out.density = keys.material.density;
  out.end = keys.time.end;
  out.stop_when_arrested = keys.time.stop_when_arrested;
  out.state = std::visit(MakeState{keys, out}, keys.setting);
  out.state.keep_ledger = keys.energy_ledger;
  out.gravity = norm(out.state.gravity);
  out.laws = dem::compile(out.model, dem::mean_pair_mass(out.state.grains));
  out.limit = dem::step_limit(out.state, out.model);
  out.state.dt = keys.time.step ? *keys.time.step : automatic_step(out);
  keys.input->root().child("time").resolve("step", out.state.dt);
}

DemInput build_unlocated(const DemKeys& keys, const Building& how) {
  DemInput out;
  for (const auto& [name, recipe] : bed_recipes(keys)) {
    auto found = find_bed(keys, how, recipe);
    if (!found) out.unsettled.push_back(recipe);
    out.beds.emplace_back(name, found ? std::move(*found) : StoredBed{recipe, {}, {}, scenario::stand_in_bed(recipe)});
  }
  if (!out.unsettled.empty()) {  // whatever can be refused is refused before a bed is settled
    assemble(keys, out);
    report(keys, dem::step_findings(out.state, out.model), out);
    if (out.scenario == "chute") (void)DemFlow(keys.input->root().child("cg"), out);
    if (how.estimate) return out;
    for (auto& [name, stored] : out.beds)
      if (stored.hash.empty()) stored = settle_and_store(stored.recipe, how.quiet);
    out.unsettled.clear();
    out.warnings.clear();
  }
  out.bed_hash = hash_of_all(out);
  expect_hash(keys, out);
  if (!out.beds.empty()) keys.input->root().child("scenario").resolve("bed_hash", out.bed_hash);
  assemble(keys, out);
  report(keys, dem::step_findings(out.state, out.model), out);
  try {
    dem::prepare(out.state, out.laws);
  } catch (const NumericalError& error) {  // no step has been taken: the start itself is wrong
    keys.input->fail("scenario", error.what());
  }
  report(keys, dem::overlap_findings(out.state), out);
  return out;
}

}  // namespace

std::vector<std::pair<std::string, BedRecipe>> bed_recipes(const DemKeys& keys) {
  std::vector<std::pair<std::string, BedRecipe>> recipes;
  const double d = keys.material.diameter;
  const auto base = [&](double length, double width, double ratio) {
    if (ratio > 0) recipes.emplace_back("base", scenario::base_recipe(length, width, ratio * d, keys.seed));
  };
  const auto patch = [&](double ratio) {
    base(scenario::base_patch * ratio * d, scenario::base_patch * ratio * d, ratio);
  };
  if (const auto* chute = std::get_if<scenario::Chute>(&keys.setting))
    base(chute->length, chute->width, chute->base_size_ratio);
  if (const auto* avalanche = std::get_if<scenario::Avalanche>(&keys.setting)) {
    base(scenario::avalanche_patch * avalanche->base_size_ratio * d, avalanche->width, avalanche->base_size_ratio);
    recipes.emplace_back("pile", scenario::avalanche_recipe(*avalanche, keys.material, keys.seed));
  }
  if (const auto* column = std::get_if<scenario::Column>(&keys.setting)) {
    patch(column->base_size_ratio);
    recipes.emplace_back("pile", scenario::column_recipe(*column, keys.material, keys.seed));
  }
  if (const auto* heap = std::get_if<scenario::Heap>(&keys.setting)) patch(heap->base_size_ratio);
  return recipes;
}

DemInput build_dem(const DemKeys& keys, const Building& how) {
  try {
    return build_unlocated(keys, how);
  } catch (const UnphysicalError& error) {
    keys.input->fail(error.key, error.text);
  }
}

}  // namespace bagnold::app

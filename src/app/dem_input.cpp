#include "app/dem_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/bed_store.hpp"
#include "app/dem_flow.hpp"
#include "app/topics.hpp"
#include "core/error.hpp"
#include "scenario/granular.hpp"

namespace bagnold::app {

namespace {

using config::Section;

const std::vector<std::string> species = {"grain", "base"};

// The laws of one pair of species; with `inherited`, keys that are absent keep the values of [contact].
dem::PairParameters read_pair(const Section& contact) {
  dem::PairParameters pair;
  pair.normal = contact.read_law<laws::NormalLaws>("normal", "linear");
  // Published values of gamma_n differ by a factor m_ij between the two conventions: never guess.
  const auto* linear = std::get_if<laws::Linear>(&pair.normal);
  if (linear != nullptr && linear->damping && !contact.has("damping_convention"))
    contact.fail("damping",
                 "damping_convention is missing, expected \"force\" (f = kn delta - gamma v) or "
                 "\"per_reduced_mass\" (f = kn delta - gamma m_ij v)");
  const bool hertz = name_of(pair.normal) == "hertz";
  pair.tangential = contact.read_law<laws::TangentialLaws>("tangential", hertz ? "mindlin" : "linear_history");
  pair.rolling = contact.read_law<laws::RollingLaws>("rolling", "none");
  return pair;
}

dem::PairParameters read_pair(const Section& contact, const dem::PairParameters& inherited) {
  dem::PairParameters pair = inherited;
  const auto read = [&](auto& law) { law = contact.read(law); };
  std::visit(read, pair.normal);
  std::visit(read, pair.tangential);
  std::visit(read, pair.rolling);
  return pair;
}

dem::ContactModel read_contacts(const Section& contact) {
  const dem::PairParameters everywhere = read_pair(contact);
  dem::ContactModel model = dem::uniform_model(species, everywhere);
  if (contact.has("base"))  // flowing grains against the base or a wall
    dem::set_pair(model, scenario::grain_species, scenario::base_species, read_pair(contact.child("base"), everywhere));
  else
    contact.ask("base");
  return model;
}

std::vector<Vec3> stored_base(double length, double width, double base_diameter, std::uint64_t seed) {
  if (base_diameter == 0) return {};
  return scenario::cut_base(stored_bed(scenario::base_recipe(length, width, base_diameter, seed)));
}

void read_scenario(const Section& section, const scenario::GrainMaterial& material, std::uint64_t seed, DemInput& out) {
  out.scenario = section.choose("kind", std::nullopt, {"chute", "avalanche", "column", "heap", "grains"});
  const double d = material.diameter;
  const auto patch_of = [&](double ratio) {
    return stored_base(scenario::base_patch * ratio * d, scenario::base_patch * ratio * d, ratio * d, seed);
  };
  if (out.scenario == "chute") {
    const auto chute = section.read<scenario::Chute>();
    out.angle_deg = chute.angle_deg;
    out.base_size_ratio = chute.base_size_ratio;
    out.fill_height = chute.fill_height;
    scenario::check_chute(chute, material);  // before the base is built
    out.state = scenario::make_chute(chute, material,
                                     stored_base(chute.length, chute.width, chute.base_size_ratio * d, seed), seed);
  } else if (out.scenario == "avalanche") {
    const auto avalanche = section.read<scenario::Avalanche>();
    scenario::check_avalanche(avalanche, material);
    const double base = avalanche.base_size_ratio * d;
    out.state = scenario::make_avalanche(avalanche, material,
                                         stored_base(scenario::avalanche_patch * base, avalanche.width, base, seed),
                                         stored_bed(scenario::avalanche_recipe(avalanche, material, seed)));
  } else if (out.scenario == "column") {
    const auto column = section.read<scenario::Column>();
    out.column_radius = column.radius;
    out.column_height = column.height;
    out.state = scenario::make_column(column, material, patch_of(column.base_size_ratio),
                                      stored_bed(scenario::column_recipe(column, material, seed)));
  } else if (out.scenario == "heap") {
    const auto heap = section.read<scenario::Heap>();
    out.column_radius = heap.radius;
    out.state = scenario::make_heap(heap, material, patch_of(heap.base_size_ratio), seed);
  } else {
    std::vector<scenario::SingleGrain> grains;
    std::vector<scenario::SingleWall> walls;
    for (const Section& item : section.list("grains")) grains.push_back(item.read<scenario::SingleGrain>());
    for (const Section& item : section.list("walls")) walls.push_back(item.read<scenario::SingleWall>());
    out.state = scenario::make_singles(section.read<scenario::Singles>(), grains, walls, material);
  }
  out.gravity = norm(out.state.gravity);
}

// That of the limiting pair; exactly collision_time/50 where that is the input.
double automatic_step(const DemInput& in) {
  if (const auto* linear = std::get_if<laws::Linear>(&in.model.pairs.front().normal))
    if (linear->collision_time && std::abs(*linear->collision_time / (50 * in.limit.step) - 1) < 1e-12)
      return *linear->collision_time / 50;
  return in.limit.step;
}

DemInput read_unlocated(config::Case& input) {
  const Section root = input.root();
  DemInput out;
  const auto seed = static_cast<std::uint64_t>(root.get<std::int64_t>("seed", 1, at_least(0)));
  const auto material = root.child("grains").read<scenario::GrainMaterial>();
  out.diameter = material.diameter;
  out.density = material.density;
  out.model = read_contacts(root.child("contact"));
  const Section time_section = root.child("time");
  const auto time = time_section.read<DemTime>();
  out.end = time.end;

  read_scenario(root.child("scenario"), material, seed, out);
  out.stop_when_arrested = time.stop_when_arrested;
  if (out.scenario == "grains" && !time_section.has("stop_when_arrested"))
    time_section.resolve("stop_when_arrested", out.stop_when_arrested = false);
  out.state.keep_ledger = root.child("output").get<bool>("energy_ledger", out.scenario == "grains");

  out.laws = dem::compile(out.model, dem::mean_pair_mass(out.state.grains));
  out.limit = dem::step_limit(out.state, out.model);
  out.state.dt = time.step ? *time.step : automatic_step(out);
  time_section.resolve("step", out.state.dt);
  try {
    dem::prepare(out.state, out.laws);
  } catch (const NumericalError& error) {  // no step has been taken: the start itself is wrong
    input.fail("scenario", error.what());
  }
  for (const dem::Finding& finding : dem::physical_findings(out.state, out.model)) {
    if (finding.error) input.fail(finding.key, finding.text);
    out.warnings.push_back(finding.key + ": " + finding.text);
  }
  return out;
}

}  // namespace

DemInput read_dem(config::Case& input) {
  try {
    return read_unlocated(input);
  } catch (const UnphysicalError& error) {
    input.fail(error.key, error.text);
  }
}

void add_dem_topics(std::vector<Topic>& topics) {
  topics.push_back(topic<scenario::Chute>("scenario of model dem"));
  topics.push_back(topic<scenario::Avalanche>("scenario of model dem"));
  topics.push_back(topic<scenario::Column>("scenario of model dem"));
  topics.push_back(topic<scenario::Heap>("scenario of model dem"));
  topics.push_back(topic<scenario::Singles>("scenario of model dem"));
  topics.push_back(topic<scenario::GrainMaterial>("section of model dem"));
  topics.push_back(topic<DemTime>("section of model dem"));
  topics.push_back(topic<CgKeys>("section of model dem"));
  add_registry<laws::NormalLaws>(topics, "normal contact law, contact.normal");
  add_registry<laws::TangentialLaws>(topics, "tangential contact law, contact.tangential");
  add_registry<laws::RollingLaws>(topics, "rolling law, contact.rolling");
  add_registry<laws::CgKernels>(topics, "coarse-graining function, cg.kernel");
}

}  // namespace bagnold::app

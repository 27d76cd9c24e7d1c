#include "app/dem_input.hpp"

#include <type_traits>

#include "app/dem_flow.hpp"
#include "app/topics.hpp"
#include "core/error.hpp"

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

void read_scenario(const Section& section, DemKeys& out) {
  out.scenario = section.choose("kind", std::nullopt, {"chute", "avalanche", "column", "heap", "grains"});
  if (out.scenario == "chute") {
    out.setting = section.read<scenario::Chute>();
  } else if (out.scenario == "avalanche") {
    out.setting = section.read<scenario::Avalanche>();
  } else if (out.scenario == "column") {
    out.setting = section.read<scenario::Column>();
  } else if (out.scenario == "heap") {
    out.setting = section.read<scenario::Heap>();
  } else {
    SinglesKeys keys{section.read<scenario::Singles>(), {}, {}};
    for (const Section& item : section.list("grains")) keys.grains.push_back(item.read<scenario::SingleGrain>());
    for (const Section& item : section.list("walls")) keys.walls.push_back(item.read<scenario::SingleWall>());
    out.setting = keys;
  }
  std::visit(
      [&](const auto& setting) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(setting)>, SinglesKeys>)
          scenario::check(setting, out.material);
      },
      out.setting);
}

void read_bed(const Section& section, DemKeys& out) {
  out.bed = section.read<BedKeys>();
  if (out.bed.bed != "auto") out.bed.bed = out.input->file(section, "bed");
}

DemKeys read_unlocated(config::Case& input) {
  const Section root = input.root();
  DemKeys out;
  out.input = &input;
  out.seed = static_cast<std::uint64_t>(root.get<std::int64_t>("seed", 1, at_least(0)));
  out.material = root.child("grains").read<scenario::GrainMaterial>();
  out.contacts = read_contacts(root.child("contact"));
  (void)dem::compile(out.contacts, 1);  // refuses what no mass can make right
  const Section time = root.child("time"), section = root.child("scenario");
  out.time = time.read<DemTime>();
  read_scenario(section, out);
  if (out.scenario == "grains" && !time.has("stop_when_arrested"))
    time.resolve("stop_when_arrested", out.time.stop_when_arrested = false);
  if (!bed_recipes(out).empty()) read_bed(section, out);
  if (out.scenario == "chute") DemFlow::read(root.child("cg"));
  out.energy_ledger = root.child("output").get<bool>("energy_ledger", out.scenario == "grains");
  return out;
}

}  // namespace

DemKeys read_dem(config::Case& input) {
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
  topics.push_back(topic<BedKeys>("scenario of model dem"));
  topics.push_back(topic<DemTime>("section of model dem"));
  topics.push_back(topic<CgKeys>("section of model dem"));
  add_registry<laws::NormalLaws>(topics, "normal contact law, contact.normal");
  add_registry<laws::TangentialLaws>(topics, "tangential contact law, contact.tangential");
  add_registry<laws::RollingLaws>(topics, "rolling law, contact.rolling");
  add_registry<laws::CgKernels>(topics, "coarse-graining function, cg.kernel");
}

}  // namespace bagnold::app

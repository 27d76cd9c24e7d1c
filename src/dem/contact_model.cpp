#include "dem/contact_model.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <utility>

#include "core/error.hpp"

namespace bagnold::dem {

namespace {

std::size_t entry(const ContactModel& model, std::int32_t a, std::int32_t b) {
  return static_cast<std::size_t>(a) * model.species.size() + static_cast<std::size_t>(b);
}

// A member set outside the range its own description gives is refused, whoever wrote it.
template <class Law>
void check_ranges(const Law& law) {
  for_each_field<Law>([&](const auto& f) {
    const auto& value = law.*(f.member);
    const auto refuse = [&](double number) {
      if (!f.range.contains(number))
        throw UnphysicalError("contact." + std::string(f.name),
                              std::to_string(number) + " is out of range, expected " + to_string(f.range));
    };
    using Member = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<Member, double>) refuse(value);
    if constexpr (std::is_same_v<Member, std::optional<double>>)
      if (value) refuse(*value);
  });
}

template <class Law, class Any>
const Law& same_kind(const Any& law) {
  if (!std::holds_alternative<Law>(law))
    throw UnphysicalError("contact", "all pairs of species must use the same kinds of law");
  return std::get<Law>(law);
}

NormalTable normal_table(const ContactModel& model, double pair_mass) {
  if (std::holds_alternative<laws::Hertz>(model.pairs.front().normal)) {
    std::vector<laws::HertzNormal<double>> table;
    for (const auto& pair : model.pairs) table.push_back(same_kind<laws::Hertz>(pair.normal).constants());
    return table;
  }
  const bool per_mass = same_kind<laws::Linear>(model.pairs.front().normal).per_reduced_mass();
  std::vector<laws::LinearNormal<double>> by_force;
  std::vector<laws::LinearNormalPerMass<double>> by_mass;
  for (const auto& pair : model.pairs) {
    const auto& law = same_kind<laws::Linear>(pair.normal);
    if (law.per_reduced_mass() != per_mass)
      throw UnphysicalError("contact.damping_convention", "must be the same for all pairs of species");
    const laws::SpringDashpot s = law.constants(pair_mass);
    by_force.push_back({s.stiffness, s.damping});
    by_mass.push_back({s.stiffness, s.damping});
  }
  if (per_mass) return by_mass;
  return by_force;
}

laws::LinearTangential<double> linear_tangential(const PairParameters& pair, double pair_mass) {
  const auto& law = same_kind<laws::LinearHistory>(pair.tangential);
  const auto* normal = std::get_if<laws::Linear>(&pair.normal);
  if (normal == nullptr && !(law.tangential_stiffness && law.tangential_damping))
    throw UnphysicalError("contact.tangential_stiffness",
                          "and tangential_damping have no automatic value unless normal = \"linear\"");
  laws::SpringDashpot s;
  if (normal != nullptr) {
    s = normal->constants(pair_mass);
    if (normal->per_reduced_mass()) s.damping *= normal->reduced_mass.value_or(pair_mass);
  }
  return {law.tangential_stiffness.value_or(2 * s.stiffness / 7), law.tangential_damping.value_or(s.damping),
          law.friction};
}

TangentialTable tangential_table(const ContactModel& model, double pair_mass) {
  if (std::holds_alternative<laws::Mindlin>(model.pairs.front().tangential)) {
    std::vector<laws::MindlinTangential<double>> table;
    for (const auto& pair : model.pairs) table.push_back(same_kind<laws::Mindlin>(pair.tangential).constants());
    return table;
  }
  std::vector<laws::LinearTangential<double>> table;
  for (const auto& pair : model.pairs) table.push_back(linear_tangential(pair, pair_mass));
  return table;
}

RollingTable rolling_table(const ContactModel& model) {
  return std::visit(
      [&](const auto& first) -> RollingTable {
        using Law = std::decay_t<decltype(first)>;
        std::vector<decltype(first.constants())> table;
        for (const auto& pair : model.pairs) table.push_back(same_kind<Law>(pair.rolling).constants());
        return table;
      },
      model.pairs.front().rolling);
}

}  // namespace

ContactModel uniform_model(std::vector<std::string> species, const PairParameters& parameters) {
  ContactModel model;
  model.pairs.assign(species.size() * species.size(), parameters);
  model.species = std::move(species);
  return model;
}

void set_pair(ContactModel& model, std::int32_t a, std::int32_t b, const PairParameters& parameters) {
  model.pairs[entry(model, a, b)] = model.pairs[entry(model, b, a)] = parameters;
}

ContactLaws compile(const ContactModel& model, double pair_mass) {
  if (model.pairs.empty() || model.pairs.size() != model.species.size() * model.species.size())
    throw UnphysicalError("contact", "expected parameters for every pair of species");
  for (const auto& pair : model.pairs) {
    std::visit([](const auto& law) { check_ranges(law); }, pair.normal);
    std::visit([](const auto& law) { check_ranges(law); }, pair.tangential);
    std::visit([](const auto& law) { check_ranges(law); }, pair.rolling);
  }
  return {static_cast<std::int32_t>(model.species.size()), normal_table(model, pair_mass),
          tangential_table(model, pair_mass), rolling_table(model)};
}

double mean_pair_mass(const Grains& grains) {
  if (grains.flowing == 0) return 0;
  double sum = 0;
  for (std::int64_t i = 0; i < grains.flowing; ++i) sum += grains.mass[static_cast<std::size_t>(i)];
  return 0.5 * sum / static_cast<double>(grains.flowing);
}

}  // namespace bagnold::dem

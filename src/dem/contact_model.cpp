#include "dem/contact_model.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
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

// The constants of every pair as one table. `law_of(pair)`: the law, of any kind; `nominal`: by pair.
template <class R, class LawOf>
Tables<R> table_of(const ContactModel& model, const std::vector<laws::NominalPair>& nominal, LawOf law_of) {
  const auto visit_constants = [&](std::size_t k, auto&& f) {
    std::visit(
        [&](const auto& law) {
          check_ranges(law);
          std::visit(f, law.constants(nominal[k]));
        },
        law_of(model.pairs[k]));
  };
  Tables<R> tables;
  visit_constants(0, [&](const auto& first) {
    using Constants = std::decay_t<decltype(first)>;
    auto& table = tables.template emplace<std::vector<Constants>>();
    for (std::size_t k = 0; k < model.pairs.size(); ++k)
      visit_constants(k, [&](const auto& constants) {
        if constexpr (std::is_same_v<std::decay_t<decltype(constants)>, Constants>)
          table.push_back(constants);
        else
          throw UnphysicalError("contact",
                                "all pairs of species must use the same kinds of law and damping_convention");
      });
  });
  return tables;
}

// What the normal laws amount to for two mean grains.
std::vector<laws::NominalPair> nominal_pairs(const Tables<laws::NormalLaws>& normal, double pair_mass) {
  std::vector<laws::NominalPair> nominal;
  std::visit(
      [&](const auto& table) {
        for (const auto& law : table) {
          const auto response = law.respond(0.0, laws::sizes(1, 1, 0.5 / pair_mass, 0.5 / pair_mass));
          nominal.push_back(
              {pair_mass, std::decay_t<decltype(law)>::constant_stiffness, response.stiffness, response.damping});
        }
      },
      normal);
  return nominal;
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
  const std::vector<laws::NominalPair> mass_only(model.pairs.size(), {.reduced_mass = pair_mass});
  const auto normal = table_of<laws::NormalLaws>(model, mass_only, [](const auto& p) { return p.normal; });
  const auto nominal = nominal_pairs(normal, pair_mass);
  return {static_cast<std::int32_t>(model.species.size()), normal,
          table_of<laws::TangentialLaws>(model, nominal, [](const auto& p) { return p.tangential; }),
          table_of<laws::RollingLaws>(model, nominal, [](const auto& p) { return p.rolling; })};
}

double mean_pair_mass(const Grains& grains) {
  if (grains.flowing == 0) return 0;
  double sum = 0;
  for (std::int64_t i = 0; i < grains.flowing; ++i) sum += grains.mass[static_cast<std::size_t>(i)];
  return 0.5 * sum / static_cast<double>(grains.flowing);
}

}  // namespace bagnold::dem

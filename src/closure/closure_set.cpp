#include "closure/closure_set.hpp"

#include <fmt/core.h>

#include <array>

namespace bagnold::closure {
namespace {

// One row of tables 1 and 2 of Weinhart et al. 2012, with the range delta3 .. delta_acc of eqs 46 and 48.
struct Row {
  std::string_view lambda;
  double delta1_deg, delta2_deg, A;  // stopping height over this base
  double beta, gamma, error;         // flow rule against the stopping height of lambda = 1
  double shape;                      // alpha for lambda <= 2/3, d_lambda of eq. 54c above
  bool rough;
  double theta_lo_deg, theta_hi_deg;
};

constexpr std::array<Row, 6> table = {{
    {"0", 12.25, 12.25, 1.0, 1.500, -4.065, 0.886, 1.000, false, 23.0, 25.0},
    {"1/2", 17.913, 21.357, 11.959, 0.300, -0.236, 0.229, 1.142, false, 24.5, 29.0},
    {"2/3", 17.217, 24.302, 11.088, 0.215, -0.143, 0.104, 1.201, false, 24.5, 29.0},
    {"5/6", 17.425, 26.828, 7.465, 0.203, 0.039, 0.113, 5.105, true, 17.425, 29.0},
    {"1", 17.708, 32.780, 3.355, 0.196, 0.040, 0.121, 6.678, true, 17.708, 29.0},
    {"2", 17.518, 29.712, 5.290, 0.189, 0.080, 0.137, 13.75, true, 17.518, 29.0},
}};
constexpr std::size_t rough_row = 4;  // lambda = 1, whose stopping height scales every flow rule (eq. 47)

// The paper has no starting angles. Layers start about one degree above the angle at which they stop (Pouliquen &
// Forterre 2002, figure 3).
constexpr double starting_offset_deg = 1.0;

ClosureSet make(const Row& row, double d, double grain_density) {
  const Row& rough = table[rough_row];
  ClosureSet set;
  set.name = fmt::format("weinhart2012/{}", row.lambda);
  set.source = "Weinhart, Thornton, Luding & Bokhove 2012, tables 1 and 2, eqs 46, 48, 50, 52-55";
  set.friction = laws::PouliquenForterre{.delta1_deg = rough.delta1_deg,
                                         .delta2_deg = rough.delta2_deg,
                                         .A = rough.A,
                                         .d = d,
                                         .beta = row.beta,
                                         .gamma = row.gamma};
  set.static_branch = {.froude_star = row.beta - row.gamma,
                       .delta1_deg = row.delta1_deg,
                       .delta2_deg = row.delta2_deg,
                       .delta3_deg = row.delta1_deg + starting_offset_deg,
                       .length = row.A * d};
  set.density = laws::ExponentialAngleDensity{};
  set.grain_density = grain_density;
  set.stress_ratio = laws::LinearAngleStressRatio{};
  if (row.rough)
    set.shape_factor = laws::StrainModelShapeFactor{
        .base_layer = row.shape, .d = d, .delta1_deg = rough.delta1_deg, .delta2_deg = rough.delta2_deg, .A = rough.A};
  else
    set.shape_factor = laws::ConstantShapeFactor{.alpha = row.shape};
  set.validity = {row.theta_lo_deg, row.theta_hi_deg};
  set.flow_rule_error = row.error;
  return set;
}

std::string describe_law(std::string_view role, const auto& any) {
  return std::visit(
      [&](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        std::string text = fmt::format("{}: {} ({})\n", role, Law::name, Law::summary);
        for_each_field<Law>(
            [&](const auto& f) { text += fmt::format("    {} = {} {}\n", f.name, law.*(f.member), f.unit); });
        return text;
      },
      any);
}

}  // namespace

bool ClosureSet::is_constant() const {
  return std::holds_alternative<laws::ConstantDensity>(density) &&
         std::holds_alternative<laws::ConstantStressRatio>(stress_ratio) &&
         std::holds_alternative<laws::ConstantShapeFactor>(shape_factor);
}

std::vector<std::string> builtin_names() {
  std::vector<std::string> names;
  for (const Row& row : table) names.push_back(fmt::format("weinhart2012/{}", row.lambda));
  return names;
}

std::optional<ClosureSet> builtin(std::string_view name, double diameter, double grain_density) {
  for (const Row& row : table)
    if (name == fmt::format("weinhart2012/{}", row.lambda)) return make(row, diameter, grain_density);
  return std::nullopt;
}

std::string describe(const ClosureSet& set) {
  std::string text = fmt::format("{}\n  {}\n", set.name, set.source);
  text += describe_law("friction", set.friction);
  text += describe_law("static branch", std::variant<laws::StaticBranch>(set.static_branch));
  text += describe_law("density", set.density) + describe_law("stress ratio", set.stress_ratio);
  text += describe_law("shape factor", set.shape_factor);
  text +=
      fmt::format("measured for {} < atan(mu) < {} degrees\n", set.validity.theta_lo_deg, set.validity.theta_hi_deg);
  if (set.flow_rule_error) text += fmt::format("err(F) = {}\n", *set.flow_rule_error);
  return text;
}

}  // namespace bagnold::closure

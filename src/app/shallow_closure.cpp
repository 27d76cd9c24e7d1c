// Closures of the shallow-layer model: a built-in set, a closure.toml, or laws written in the case.
#include <fmt/format.h>

#include <algorithm>

#include "app/shallow_input.hpp"
#include "core/fields.hpp"

namespace bagnold::app {
namespace {

using config::Case;
using config::Section;

// Throws at the first key of `s` that is not `known`; fits may add covariances, errors (x_err) and remarks.
void expect_keys(const Section& s, std::vector<std::string> known) {
  for (const std::string& key : s.keys()) {
    if (key == "covariance" || key == "source" || key.ends_with("_err")) continue;
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string hint = nearest(key, known);
    s.fail(key, fmt::format("unknown key \"{}\", expected one of {}{}", key, fmt::join(known, ", "),
                            hint.empty() ? "" : fmt::format("; did you mean \"{}\"?", hint)));
  }
}

template <class Law>
Law flow_rule_law(const Section& height, const Section& rule, double d) {
  Law law;
  law.delta1_deg = height.get<double>("delta1_deg", std::nullopt, open(0, 90), "deg");
  law.delta2_deg = height.get<double>("delta2_deg", std::nullopt, open(law.delta1_deg, 90), "deg");
  law.A = height.get<double>("A", std::nullopt, positive(), "d");
  law.d = d;
  law.beta = rule.get<double>("beta", std::nullopt, positive());
  law.gamma = rule.get<double>("gamma", std::nullopt);
  return law;
}

// closure.toml: [stopping_height] and [flow_rule.<lambda>] make the friction law, the rest is optional.
closure::ClosureSet from_file(const std::string& path, const std::string& lambda, double d, double grain_density) {
  Case file = Case::from_file(path);
  const Section root = file.root(), height = root.child("stopping_height");
  closure::ClosureSet set;
  set.name = path;
  set.source = "closure file";
  set.grain_density = grain_density;
  expect_keys(root,
              {"stopping_height", "flow_rule", "density", "stress_ratio", "shape_factor", "validity", "provenance"});
  expect_keys(height, {"law", "delta1_deg", "delta2_deg", "A"});
  const Section rules = root.child("flow_rule");
  const auto known = rules.keys();
  if (known.empty()) root.fail("flow_rule", "expected [flow_rule.<lambda>] with beta and gamma");
  if (!rules.has(lambda))
    rules.fail(lambda, fmt::format("no flow rule for lambda = {}; there are {}", lambda, fmt::join(known, ", ")));
  const Section rule = rules.child(lambda);
  expect_keys(rule, {"beta", "gamma", "err"});
  if (rule.has("err")) set.flow_rule_error = rule.get<double>("err", std::nullopt, non_negative());
  const std::string shape = height.choose("law", "pouliquen-forterre", {"pouliquen-forterre", "exponential"});
  const auto law = flow_rule_law<laws::PouliquenForterre>(height, rule, d);
  if (shape == "exponential")
    set.friction = flow_rule_law<laws::ExponentialFriction>(height, rule, d);
  else
    set.friction = law;
  set.static_branch = {.froude_star = std::max(0.0, law.beta - law.gamma),
                       .delta1_deg = law.delta1_deg,
                       .delta2_deg = law.delta2_deg,
                       .delta3_deg = std::min(law.delta1_deg + 1, 89.0),
                       .length = law.A * d};
  expect_keys(root.child("density"), {"c0", "c1_deg", "c2_deg"});
  expect_keys(root.child("stress_ratio"), {"d0_deg", "d1_deg"});
  expect_keys(root.child("shape_factor"), {"alpha", "base_layer"});
  expect_keys(root.child("validity"), {"theta_deg"});
  if (const Section s = root.child("density"); root.has("density"))
    set.density = laws::ExponentialAngleDensity{s.get<double>("c0", std::nullopt, open(0, 1)),
                                                s.get<double>("c1_deg", std::nullopt, positive(), "deg"),
                                                s.get<double>("c2_deg", std::nullopt, any_number(), "deg")};
  if (const Section s = root.child("stress_ratio"); root.has("stress_ratio"))
    set.stress_ratio = laws::LinearAngleStressRatio{s.get<double>("d0_deg", std::nullopt, positive(), "deg"),
                                                    s.get<double>("d1_deg", std::nullopt, any_number(), "deg")};
  if (const Section s = root.child("shape_factor"); root.has("shape_factor")) {
    if (s.has("alpha"))
      set.shape_factor = laws::ConstantShapeFactor{s.get<double>("alpha", std::nullopt, at_least(1))};
    else
      set.shape_factor =
          laws::StrainModelShapeFactor{.base_layer = s.get<double>("base_layer", 6.678, non_negative(), "d"),
                                       .surface_layer = 5,
                                       .d = d,
                                       .delta1_deg = law.delta1_deg,
                                       .delta2_deg = law.delta2_deg,
                                       .A = law.A};
  }
  set.validity = {law.delta1_deg, 29};
  if (const Section s = root.child("validity"); s.has("theta_deg")) {
    const auto range = s.get<std::vector<double>>("theta_deg", std::nullopt, open(0, 90), "deg");
    if (range.size() != 2 || !(range[1] > range[0])) s.fail("theta_deg", "expected [lowest, highest] angle");
    set.validity = {range[0], range[1]};
  }
  return set;
}

}  // namespace

closure::ClosureSet read_closure(const Case& input) {
  const Section s = input.root().child("closure");
  const std::string name = s.get<std::string>("set", "custom");
  const double d = s.get<double>("diameter", 1.0, positive(), "length");
  const double grain_density = s.get<double>("grain_density", 1.0, positive(), "mass/length^3");
  closure::ClosureSet set;
  if (name.ends_with(".toml")) {
    set = from_file(input.file(s, "set"), s.get<std::string>("lambda", "1"), d, grain_density);
  } else if (name != "custom") {
    const auto known = closure::builtin(name, d, grain_density);
    if (!known)
      s.fail("set", fmt::format("no closure set \"{}\"; expected custom, a .toml file, or one of {}", name,
                                fmt::join(closure::builtin_names(), ", ")));
    set = *known;
  }
  const bool custom = name == "custom";
  set.grain_density = grain_density;
  // Each law may be replaced in its own section.
  if (custom || s.has("friction")) {
    set.friction = s.child("friction").read_law<laws::FrictionLaws>("law", "coulomb");
    set.static_branch = {};
  }
  if (s.has("static_branch")) set.static_branch = s.child("static_branch").read<laws::StaticBranch>();
  if (custom || s.has("density")) set.density = s.child("density").read_law<laws::DensityLaws>("law", "constant");
  if (custom || s.has("stress_ratio"))
    set.stress_ratio = s.child("stress_ratio").read_law<laws::StressRatioLaws>("law", "constant");
  if (custom || s.has("shape_factor"))
    set.shape_factor = s.child("shape_factor").read_law<laws::ShapeFactorLaws>("law", "constant");
  return set;
}

}  // namespace bagnold::app

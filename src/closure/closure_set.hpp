// What closes the shallow-layer equations: friction, mean density, stress ratio, shape factor; plain data.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "laws/registries.hpp"

namespace bagnold::closure {

// Where the closure was measured: lo < atan(mu) < hi (degrees). Outside it density, stress ratio and shape factor
// keep their value at the nearer end.
struct Validity {
  double theta_lo_deg = 0, theta_hi_deg = 89;
};

struct ClosureSet {
  std::string name = "custom", source;
  laws::FrictionLaws::Any friction = laws::Coulomb{};
  laws::StaticBranch static_branch;  // off unless froude_star > 0
  laws::DensityLaws::Any density = laws::ConstantDensity{};
  double grain_density = 1;  // rho_p, mass/length^3
  laws::StressRatioLaws::Any stress_ratio = laws::ConstantStressRatio{};
  laws::ShapeFactorLaws::Any shape_factor = laws::ConstantShapeFactor{};
  Validity validity;
  std::optional<double> flow_rule_error;  // err(F) of the fit, eq. 49
  bool is_constant() const;               // density, stress ratio and shape factor are numbers
};

// The sets that ship with the program: "weinhart2012/0", "/1/2", "/2/3", "/5/6", "/1", "/2" for the ratio lambda of base to
// flowing grains; tables 1 and 2 and eqs 46, 48, 52-55. `diameter` and `grain_density` give them their units.
std::vector<std::string> builtin_names();
std::optional<ClosureSet> builtin(std::string_view name, double diameter, double grain_density);

// A paragraph a reader can check against the paper.
std::string describe(const ClosureSet& set);

}  // namespace bagnold::closure

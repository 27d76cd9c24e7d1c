// The fields, each declared once: name, unit, meaning, and how it follows from the averaged sums. Stresses are compression
// positive here and in every output.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "cg/channels.hpp"
#include "cg/grid.hpp"

namespace bagnold::cg {

// Averages at one place. Ratios are formed from averages, so that the balances stay exact in the mean.
struct Local {
  const Row& mean;
  const Gradient& gradient;  // of rho and p
  double kernel_width;       // w: the shear across it adds rho w^2 (dV_a/dr)(dV_b/dr) to the kinetic stress
  double least_density;      // below it there is no material: velocities and other ratios are NaN
};

struct FieldDefinition {
  std::string name, unit, meaning;
  std::function<double(const Local&)> value;
};

const std::vector<FieldDefinition>& all_fields();
const FieldDefinition& field_named(std::string_view name);  // throws InputError for an unknown name

// Density below which a place counts as empty: a millionth of the densest.
double least_density(const std::vector<Row>& rows);

}  // namespace bagnold::cg

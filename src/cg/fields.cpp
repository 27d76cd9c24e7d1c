#include "cg/fields.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/vec3.hpp"

namespace bagnold::cg {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::string_view axis = "xyz";

bool is_empty(const Local& at) { return !(at.mean[kMass] > at.least_density); }
double ratio(const Local& at, double numerator, double denominator) {
  return is_empty(at) || denominator == 0 ? nothing : numerator / denominator;
}

double velocity(const Local& at, std::size_t a) { return at.mean[kMomentum + a] / at.mean[kMass]; }

// dV_a/dr_b = (dp_a/dr_b - V_a drho/dr_b) / rho
double velocity_gradient(const Local& at, std::size_t a, std::size_t b) {
  return (at.gradient.d[b][kMomentum + a] - velocity(at, a) * at.gradient.d[b][kMass]) / at.mean[kMass];
}

double contact(const Local& at, std::size_t a, std::size_t b) {
  return 0 - at.mean[kContact + 3 * a + b];
}  // no negative zeros
double base(const Local& at, std::size_t a, std::size_t b) { return 0 - at.mean[kBase + 3 * a + b]; }
// <m v v W> - p p / rho; contains the shear across the kernel and the Reynolds stress of slow fluctuations.
double kinetic(const Local& at, std::size_t a, std::size_t b) {
  if (at.mean[kMass] <= 0) return 0;
  return at.mean[kFlux + symmetric(a, b)] - at.mean[kMomentum + a] * at.mean[kMomentum + b] / at.mean[kMass];
}
double total(const Local& at, std::size_t a, std::size_t b) {
  return contact(at, a, b) + base(at, a, b) + kinetic(at, a, b);
}

double pressure(const Local& at) { return (total(at, 0, 0) + total(at, 1, 1) + total(at, 2, 2)) / 3; }
double temperature(const Local& at) {
  return (kinetic(at, 0, 0) + kinetic(at, 1, 1) + kinetic(at, 2, 2)) / (3 * at.mean[kMass]);
}

// What the shear across the kernel adds to the kinetic stress.
double shear_bias(const Local& at, std::size_t a, std::size_t b) {
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c) sum += velocity_gradient(at, a, c) * velocity_gradient(at, b, c);
  return at.mean[kMass] * at.kernel_width * at.kernel_width * sum;
}

// sqrt(2 D:D) of the deviatoric rate of strain; |du/dz| in simple shear.
double shear_rate(const Local& at) {
  Tensor3 D;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      D(a, b) = 0.5 * (velocity_gradient(at, static_cast<std::size_t>(a), static_cast<std::size_t>(b)) +
                       velocity_gradient(at, static_cast<std::size_t>(b), static_cast<std::size_t>(a)));
  const double third = trace(D) / 3;
  double sum = 0;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) sum += std::pow(D(a, b) - (a == b ? third : 0), 2);
  return std::sqrt(2 * sum);
}

double inertial_number(const Local& at) {
  const double P = pressure(at), size = at.mean[kVolumeSize] / at.mean[kVolume],
               grain_density = at.mean[kMass] / at.mean[kVolume];
  return P > 0 ? shear_rate(at) * size / std::sqrt(P / grain_density) : nothing;
}

// |deviatoric stress| / P with |s| = sqrt(s:s/2) of the symmetric part.
double stress_ratio(const Local& at) {
  const double P = pressure(at);
  double sum = 0;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b)
      sum += std::pow(0.5 * (total(at, a, b) + total(at, b, a)) - (a == b ? P : 0), 2);
  return P > 0 ? std::sqrt(sum / 2) / P : nothing;
}

using Definitions = std::vector<FieldDefinition>;

void add_vector(Definitions& all, std::string prefix, std::string unit, std::string meaning,
                std::function<double(const Local&, std::size_t)> f) {
  for (std::size_t a = 0; a < 3; ++a)
    all.push_back({fmt::format("{}_{}", prefix, axis[a]), unit, meaning + fmt::format(", {}", axis[a]),
                   [f, a](const Local& at) { return f(at, a); }});
}
void add_tensor(Definitions& all, std::string prefix, std::string unit, std::string meaning, bool is_symmetric,
                std::function<double(const Local&, std::size_t, std::size_t)> f) {
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = is_symmetric ? a : 0; b < 3; ++b)
      all.push_back({fmt::format("{}_{}{}", prefix, axis[a], axis[b]), unit,
                     fmt::format("{}, {}{}", meaning, axis[a], axis[b]),
                     [f, a, b](const Local& at) { return f(at, a, b); }});
}

// f where there is material, NaN elsewhere.
auto in_material(double (*f)(const Local&)) {
  return [f](const Local& at) { return is_empty(at) ? nothing : f(at); };
}

void add_kinematics(Definitions& all) {
  all.push_back({"phi", "1", "solid fraction", [](const Local& at) { return at.mean[kVolume]; }});
  all.push_back({"rho", "mass/length^3", "bulk density", [](const Local& at) { return at.mean[kMass]; }});
  add_vector(all, "u", "length/time", "velocity p/rho",
             [](const Local& at, std::size_t a) { return is_empty(at) ? nothing : velocity(at, a); });
  add_vector(all, "p", "mass/(length^2 time)", "momentum density",
             [](const Local& at, std::size_t a) { return at.mean[kMomentum + a]; });
  add_tensor(all, "grad_u", "1/time", "velocity gradient du_a/dr_b", false,
             [](const Local& at, std::size_t a, std::size_t b) {
               return is_empty(at) ? nothing : velocity_gradient(at, a, b);
             });
  all.push_back({"shear_rate", "1/time", "sqrt(2 D:D) of the deviatoric rate of strain, |du_x/dz| in simple shear",
                 in_material(shear_rate)});
}

void add_stresses(Definitions& all) {
  const std::string unit = "mass/(length time^2)";
  add_tensor(all, "sigma", unit, "stress, compression positive: contact + base + kinetic", false, total);
  add_tensor(all, "sigma_c", unit, "stress of contacts between flowing grains", false, contact);
  add_tensor(all, "sigma_b", unit, "stress of contacts with the base", false, base);
  add_tensor(all, "sigma_k", unit, "kinetic stress, shear across the kernel included", false, kinetic);
  add_tensor(all, "sigma_shear", unit,
             "part of the kinetic stress that is the mean shear across the kernel, rho w^2 (dV_a/dr)(dV_b/dr)", true,
             [](const Local& at, std::size_t a, std::size_t b) { return is_empty(at) ? 0.0 : shear_bias(at, a, b); });
  all.push_back({"pressure", unit, "trace of the stress over three", pressure});
  all.push_back(
      {"mu", "1", "-sigma_xz/sigma_zz", [](const Local& at) { return ratio(at, -total(at, 0, 2), total(at, 2, 2)); }});
  all.push_back({"stress_ratio", "1", "sqrt(s:s/2)/pressure, s the deviatoric stress", in_material(stress_ratio)});
  all.push_back({"inertial_number", "1",
                 "shear_rate d/sqrt(pressure/grain density), d the volume-weighted mean diameter",
                 in_material(inertial_number)});
  all.push_back({"temperature", "length^2/time^2", "granular temperature, trace of sigma_k over 3 rho",
                 in_material(temperature)});
  all.push_back({"temperature_unsheared", "length^2/time^2",
                 "granular temperature without the mean shear across the kernel", [](const Local& at) {
                   if (is_empty(at)) return nothing;
                   return temperature(at) -
                          (shear_bias(at, 0, 0) + shear_bias(at, 1, 1) + shear_bias(at, 2, 2)) / (3 * at.mean[kMass]);
                 }});
}

void add_structure(Definitions& all) {
  all.push_back({"coordination", "1", "contacts per grain, volume-weighted", [](const Local& at) {
                   return ratio(at, at.mean[kFabric] + at.mean[kFabric + 3] + at.mean[kFabric + 5], at.mean[kVolume]);
                 }});
  add_tensor(all, "fabric", "1",
             "volume-weighted sum of n_a n_b over the contacts of a grain; trace = phi times coordination", true,
             [](const Local& at, std::size_t a, std::size_t b) { return at.mean[kFabric + symmetric(a, b)]; });
  add_vector(all, "spin", "mass/(length time)", "density of angular momentum of the grains about their centres",
             [](const Local& at, std::size_t a) { return at.mean[kSpin + a]; });
  add_vector(all, "omega", "1/time", "mean angular velocity, weighted by moment of inertia",
             [](const Local& at, std::size_t a) { return ratio(at, at.mean[kSpin + a], at.mean[kInertia]); });
  all.push_back(
      {"number_density", "1/length^3", "grains per volume", [](const Local& at) { return at.mean[kNumber]; }});
  all.push_back({"mean_diameter", "length", "volume-weighted mean diameter",
                 [](const Local& at) { return ratio(at, at.mean[kVolumeSize], at.mean[kVolume]); }});
}

}  // namespace

const std::vector<FieldDefinition>& all_fields() {
  static const Definitions all = [] {
    Definitions list;
    add_kinematics(list);
    add_stresses(list);
    add_structure(list);
    return list;
  }();
  return all;
}

const FieldDefinition& field_named(std::string_view name) {
  std::vector<std::string> known;
  for (const FieldDefinition& f : all_fields()) {
    if (f.name == name) return f;
    known.push_back(f.name);
  }
  const std::string close = nearest(name, known);
  throw InputError(fmt::format("error: no field is called '{}'{}", name,
                               close.empty() ? "" : fmt::format(", did you mean '{}'", close)));
}

double least_density(const std::vector<Row>& rows) {
  double most = 0;
  for (const Row& r : rows) most = std::max(most, r[kMass]);
  return 1e-6 * most;
}

}  // namespace bagnold::cg

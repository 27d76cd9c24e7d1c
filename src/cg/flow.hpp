// From depth profiles to the numbers of a flow: height (Weinhart et al. 2012, eqs 41, 42), depth averages, Froude number,
// shape and stress factors, friction at the base, layering, steadiness (figure 5), and the error of each.
#pragma once
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

#include "cg/blocks.hpp"
#include "core/fields.hpp"

namespace bagnold::cg {

// What the analysis has to know of the flow.
struct FlowSetting {
  Vec3 gravity{0, 0, -1};  // z normal to the base
  double diameter = 1;     // of the flowing grains
};

// A number that does not exist for a profile (no material, a flow too thin for a bulk, no velocity) is nothing.
struct FlowNumbers {
  using Number = std::optional<double>;
  Number h, base, surface;
  Number u_bar, froude, mu_base, mu_cg, phi_bulk, phi_mean, K, alpha;
  Number layering, residual, lithostatic_error, friction_angle_error_deg, contacts_per_grain;

  static constexpr auto fields() {
    return std::tuple{
        field("h", "length", "height s - b of the flow (eq. 42)", &FlowNumbers::h),
        field("base", "length", "z of the base b: sigma_zz extrapolated to its maximum (eq. 42)", &FlowNumbers::base),
        field("surface", "length", "z of the surface s: sigma_zz extrapolated to zero (eq. 42)", &FlowNumbers::surface),
        field("u_bar", "length/time", "depth average of u_x", &FlowNumbers::u_bar),
        field("froude", "1", "u_bar / sqrt(g h cos theta)", &FlowNumbers::froude),
        field("mu_base", "1", "friction at the base, |F_x|/F_z of all contacts with the base", &FlowNumbers::mu_base),
        field("mu_cg", "1", "-sigma_xz/sigma_zz of the fields at z = b", &FlowNumbers::mu_cg),
        field("phi_bulk", "1", "solid fraction averaged over [b + 2d, s - 4d]", &FlowNumbers::phi_bulk),
        field("phi_mean", "1", "solid fraction averaged over [b, s]", &FlowNumbers::phi_mean),
        field("K", "1", "ratio of the depth averages of sigma_xx and sigma_zz", &FlowNumbers::K),
        field("alpha", "1", "depth average of u_x^2 over u_bar^2", &FlowNumbers::alpha),
        field("layering", "1",
              "order of layers in the bulk, 0 (none) to 1: largest |sum m exp(ikz)|/sum m over wavelengths 0.75 d to "
              "1.1 d",
              &FlowNumbers::layering),
        field("residual", "1", "depth-averaged norm of d(rho u)/dt from the balance (44), over rho g (figure 5)",
              &FlowNumbers::residual),
        field("lithostatic_error", "1", "largest |sigma_zz - weight above| in [b, s] over its maximum (eq. 41)",
              &FlowNumbers::lithostatic_error),
        field("friction_angle_error_deg", "deg", "largest |atan mu(z) - theta| in [b + d, s - 2d]",
              &FlowNumbers::friction_angle_error_deg),
        field("contacts_per_grain", "1", "contacts per flowing grain, those with the base included, each counted once",
              &FlowNumbers::contacts_per_grain)};
  }
};

FlowNumbers analyse(const MeanProfile& profile, const FlowSetting& setting);

// One standard error for each number of FlowNumbers, by a delete-a-group jackknife over the blocks: the largest of those with 8, 16 and
// 32 groups, because short groups of correlated samples look too good. Nothing with fewer than 8 blocks.
FlowNumbers errors(const BlockedProfile& profile, const FlowSetting& setting);

// Figure 5: residual against the averaging time, each value averaged over the disjoint windows of that length.
struct SteadinessPoint {
  double duration, residual;
};
std::vector<SteadinessPoint> steadiness(const BlockedProfile& profile, const FlowSetting& setting);

// d(rho u)/dt at the nodes by the balance (44): d sigma/dz + rho g - d(rho u u_z)/dz.
std::vector<Vec3> momentum_rate(const MeanProfile& profile, const Vec3& gravity);

// Integral over [lo, hi] of a function known at the nodes, linear in between.
double integrate_nodes(const std::vector<double>& z, const std::vector<double>& f, double lo, double hi);

}  // namespace bagnold::cg

#include "cg/flow.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace bagnold::cg {
namespace {

// Component (a, b) of the whole stress, compression positive. Nodes without material carry no kinetic stress.
double stress(const Row& q, std::size_t a, std::size_t b) {
  const double reynolds = q[kMass] > 0 ? q[kMomentum + a] * q[kMomentum + b] / q[kMass] : 0;
  return -q[kContact + 3 * a + b] - q[kBase + 3 * a + b] + q[kFlux + symmetric(a, b)] - reynolds;
}

struct Column {
  std::vector<double> rho, phi, u, u2, s_xx, s_xz, s_zz;
};

Column columns(const MeanProfile& p) {
  Column c;
  double most = 0;
  for (const Row& q : p.value) most = std::max(most, q[kMass]);
  for (const Row& q : p.value) {
    const double u = q[kMass] > 1e-6 * most ? q[kMomentum] / q[kMass] : 0;
    c.rho.push_back(q[kMass]);
    c.phi.push_back(q[kVolume]);
    c.u.push_back(u);
    c.u2.push_back(u * u);
    c.s_xx.push_back(stress(q, 0, 0));
    c.s_xz.push_back(stress(q, 0, 2));
    c.s_zz.push_back(stress(q, 2, 2));
  }
  return c;
}

double at_height(const std::vector<double>& z, const std::vector<double>& f, double where) {
  const auto above = std::upper_bound(z.begin(), z.end(), where);
  if (above == z.begin()) return f.front();
  if (above == z.end()) return f.back();
  const auto n = static_cast<std::size_t>(above - z.begin());
  const double t = (where - z[n - 1]) / (z[n] - z[n - 1]);
  return (1 - t) * f[n - 1] + t * f[n];
}

// Where f crosses `level` between nodes n - 1 and n.
double crossing(const std::vector<double>& z, const std::vector<double>& f, std::size_t n, double level) {
  return z[n - 1] + (level - f[n - 1]) / (f[n] - f[n - 1]) * (z[n] - z[n - 1]);
}

// Base and surface by eq. (42).
bool find_height(const std::vector<double>& z, const std::vector<double>& s_zz, FlowNumbers& out) {
  constexpr double kappa = 0.01;  // the paper's threshold
  const double peak = *std::max_element(s_zz.begin(), s_zz.end());
  if (!(peak > 0)) return false;
  std::size_t low = 1, high = s_zz.size() - 1;
  // z1 is sought from the place of the maximum upwards: below the base sigma_zz is constant, or falls where grains lie between
  // those of the base.
  low = static_cast<std::size_t>(std::max_element(s_zz.begin(), s_zz.end()) - s_zz.begin());
  while (low < s_zz.size() && s_zz[low] >= (1 - kappa) * peak) ++low;
  while (high > 0 && s_zz[high - 1] <= kappa * peak) --high;
  if (low >= s_zz.size() || low == 0 || high == 0 || high < low) return false;
  const double z1 = crossing(z, s_zz, low, (1 - kappa) * peak), z2 = crossing(z, s_zz, high, kappa * peak);
  const double beyond = kappa / (1 - 2 * kappa) * (z2 - z1);
  out.base = z1 - beyond;
  out.surface = z2 + beyond;
  out.h = z2 - z1 + 2 * beyond;
  return true;
}

// Largest normalised Fourier amplitude of the mass in [lo, hi], with a Hann window so that the ends do not count; the damping
// of a Gaussian kernel of that width is undone.
double layer_order(const MeanProfile& p, const std::vector<double>& rho, double lo, double hi, double d) {
  double best = 0;
  for (double wavelength = 0.75 * d; wavelength <= 1.1 * d; wavelength += 0.01 * d) {
    const double k = 2 * std::numbers::pi / wavelength;
    std::complex<double> sum = 0;
    double mass = 0;
    for (std::size_t n = 0; n < rho.size(); ++n) {
      if (p.z[n] < lo || p.z[n] > hi) continue;
      const double window = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (p.z[n] - lo) / (hi - lo));
      sum += window * rho[n] * std::polar(1.0, k * p.z[n]);
      mass += window * rho[n];
    }
    if (mass > 0) best = std::max(best, std::abs(sum) / mass * std::exp(0.5 * k * k * p.kernel_width * p.kernel_width));
  }
  return best;
}

void add_bulk(const MeanProfile& p, const Column& c, double d, FlowNumbers& out) {
  const double lo = *out.base + 2 * d, hi = *out.surface - 4 * d;
  if (hi - lo < 2 * d) return;  // too thin to have a bulk
  out.phi_bulk = integrate_nodes(p.z, c.phi, lo, hi) / (hi - lo);
  // Layers are sought up to two diameters below the surface, over four of them at least. A wide kernel has smoothed them
  // away: what undoing it would show is noise.
  const double top = *out.surface - 2 * d;
  if (top - lo >= 4 * d && p.kernel_width <= 0.4 * d) out.layering = layer_order(p, c.rho, lo, top, d);
}

void add_balances(const MeanProfile& p, const Column& c, const FlowSetting& setting, FlowNumbers& out) {
  const double b = *out.base, s = *out.surface, d = setting.diameter, g_z = -setting.gravity.z;
  const double theta = std::atan2(setting.gravity.x, g_z), peak = *std::max_element(c.s_zz.begin(), c.s_zz.end());
  double weight = 0, lithostatic = 0, angle = 0;
  for (std::size_t n = p.z.size() - 1; n-- > 0;) {
    weight += 0.5 * (c.rho[n] + c.rho[n + 1]) * (p.z[n + 1] - p.z[n]) * g_z;
    if (p.z[n] < b || p.z[n] > s) continue;
    lithostatic = std::max(lithostatic, std::abs(c.s_zz[n] - weight) / peak);
    if (p.z[n] >= b + d && p.z[n] <= s - 2 * d)
      angle = std::max(angle, std::abs(std::atan2(-c.s_xz[n], c.s_zz[n]) - theta));
  }
  out.lithostatic_error = lithostatic;
  if (s - b > 3 * d) out.friction_angle_error_deg = angle * 180 / std::numbers::pi;
  const std::vector<Vec3> rate = momentum_rate(p, setting.gravity);
  std::vector<double> square;
  for (const Vec3& r : rate) square.push_back(norm2(r));
  const double rho_g = integrate_nodes(p.z, c.rho, b, s) / (s - b) * norm(setting.gravity);
  if (rho_g > 0) out.residual = std::sqrt(integrate_nodes(p.z, square, b, s) / (s - b)) / rho_g;
}

// Group `k` of `groups` nearly equal ones: first block and number of blocks.
std::pair<std::int64_t, std::int64_t> group(std::int64_t blocks, std::int64_t groups, std::int64_t k) {
  const std::int64_t begin = k * blocks / groups, end = (k + 1) * blocks / groups;
  return {begin, end - begin};
}

// Standard error of each number from the averages that leave out one group each; nothing if one of them lacks the number.
FlowNumbers jackknife(const BlockedProfile& profile, const FlowSetting& setting, std::int64_t groups) {
  std::vector<FlowNumbers> without;
  for (std::int64_t k = 0; k < groups; ++k) {
    const auto [first, count] = group(profile.complete_blocks(), groups, k);
    without.push_back(analyse(profile.mean_without(first, count), setting));
  }
  FlowNumbers out;
  for_each_field<FlowNumbers>([&](const auto& f) {
    double mean = 0, square = 0;
    for (const FlowNumbers& w : without) {
      if (!(w.*f.member)) return;
      mean += *(w.*f.member) / static_cast<double>(groups);
    }
    for (const FlowNumbers& w : without) square += std::pow(*(w.*f.member) - mean, 2);
    out.*f.member = std::sqrt(square * static_cast<double>(groups - 1) / static_cast<double>(groups));
  });
  return out;
}

}  // namespace

double integrate_nodes(const std::vector<double>& z, const std::vector<double>& f, double lo, double hi) {
  double sum = 0;
  for (std::size_t n = 1; n < z.size(); ++n) {
    const double a = std::max(lo, z[n - 1]), b = std::min(hi, z[n]);
    if (a >= b) continue;
    const double middle = (0.5 * (a + b) - z[n - 1]) / (z[n] - z[n - 1]);
    sum += (b - a) * ((1 - middle) * f[n - 1] + middle * f[n]);
  }
  return sum;
}

std::vector<Vec3> momentum_rate(const MeanProfile& p, const Vec3& gravity) {
  std::vector<Vec3> rate(p.z.size());
  for (std::size_t n = 0; n < p.z.size(); ++n)
    for (std::size_t a = 0; a < 3; ++a)
      rate[n][static_cast<int>(a)] = p.slope[n][kContact + 3 * a + 2] + p.slope[n][kBase + 3 * a + 2] -
                                     p.slope[n][kFlux + symmetric(a, 2)] +
                                     p.value[n][kMass] * gravity[static_cast<int>(a)];
  return rate;
}

FlowNumbers analyse(const MeanProfile& p, const FlowSetting& setting) {
  FlowNumbers out;
  if (p.samples == 0) return out;
  const Column c = columns(p);
  const double g_z = -setting.gravity.z;
  double grains = 0;
  for (const Row& q : p.value) grains += q[kNumber] * p.spacing * p.area;
  if (grains > 0) out.contacts_per_grain = p.contacts / grains;
  if (p.base_force.z < 0) out.mu_base = std::abs(p.base_force.x) / -p.base_force.z;
  if (!find_height(p.z, c.s_zz, out)) return out;
  const double b = *out.base, s = *out.surface, h = *out.h;
  const auto depth_average = [&](const std::vector<double>& f) { return integrate_nodes(p.z, f, b, s) / h; };
  const double s_zz = depth_average(c.s_zz);
  out.phi_mean = depth_average(c.phi);
  out.u_bar = depth_average(c.u);
  if (g_z > 0) out.froude = *out.u_bar / std::sqrt(g_z * h);
  if (*out.u_bar != 0) out.alpha = depth_average(c.u2) / (*out.u_bar * *out.u_bar);
  if (s_zz > 0) out.K = depth_average(c.s_xx) / s_zz;
  const double s_zz_base = at_height(p.z, c.s_zz, b);
  if (s_zz_base > 0) out.mu_cg = -at_height(p.z, c.s_xz, b) / s_zz_base;
  add_bulk(p, c, setting.diameter, out);
  add_balances(p, c, setting, out);
  return out;
}

FlowNumbers errors(const BlockedProfile& profile, const FlowSetting& setting) {
  FlowNumbers out;
  for (std::int64_t groups : {8, 16, 32}) {
    if (profile.complete_blocks() < groups) break;
    const FlowNumbers e = jackknife(profile, setting, groups);
    for_each_field<FlowNumbers>([&](const auto& f) {
      if (e.*f.member) out.*f.member = std::max((out.*f.member).value_or(0), *(e.*f.member));
    });
  }
  return out;
}

std::vector<SteadinessPoint> steadiness(const BlockedProfile& profile, const FlowSetting& setting) {
  std::vector<SteadinessPoint> points;
  const std::int64_t blocks = profile.complete_blocks();
  for (std::int64_t length = 1; length <= blocks; length = std::max(length + 1, length * 5 / 4)) {
    double sum = 0, duration = 0;
    std::int64_t windows = 0;
    for (std::int64_t first = 0; first + length <= blocks; first += length) {
      const MeanProfile p = profile.mean(first, length);
      const FlowNumbers f = analyse(p, setting);
      if (!f.residual) continue;
      sum += *f.residual;
      if (p.samples > 1)
        duration += (p.end - p.begin) * static_cast<double>(p.samples) / static_cast<double>(p.samples - 1);
      ++windows;
    }
    if (windows > 0) points.push_back({duration / static_cast<double>(windows), sum / static_cast<double>(windows)});
  }
  return points;
}

}  // namespace bagnold::cg

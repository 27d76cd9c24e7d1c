#include "scenario/inclined_plane.hpp"

#include <algorithm>
#include <cmath>

#include "core/constants.hpp"
#include "core/error.hpp"

namespace bagnold::scenario {
namespace {

// Number of spacings in a length, at least one.
std::int64_t cells_in(double length, double spacing) {
  return std::max<std::int64_t>(1, std::llround(length / spacing));
}

}  // namespace

void set_geometry(const InclinedPlane& plane, sph::Model& model) {
  const double theta = plane.angle_deg * M_PI / 180, g = earth_gravity;
  model.dim = 2;
  model.axisymmetric = false;
  model.floor = true;
  model.spacing = plane.spacing;
  model.period = {static_cast<double>(cells_in(plane.length, plane.spacing)) * plane.spacing, 0, 0};
  model.gravity = {g * std::sin(theta), -g * std::cos(theta), 0};
}

sph::Particles make_particles(const InclinedPlane& plane, const sph::Model& model) {
  const std::int64_t across = cells_in(plane.length, plane.spacing), up = cells_in(plane.height, plane.spacing);
  auto p = sph::make_particles(across * up, 2);
  const double rho0 = model.phi_max() * model.grains().grain_density, Kt = model.grains().compressibility;
  const double row = plane.spacing * steady_flow(plane, model).phi / model.phi_max();
  for (std::int64_t a = 0, i = 0; a < across; ++a)
    for (std::int64_t b = 0; b < up; ++b, ++i) {
      const auto k = static_cast<std::size_t>(i);
      p.x[0][k] = (static_cast<double>(a) + 0.5) * plane.spacing;
      p.x[1][k] = (static_cast<double>(b) + 0.5) * row;
      const double pressure = -rho0 * model.gravity[1] * (static_cast<double>(up) * row - p.x[1][k]);
      p.root[k] = std::sqrt(Kt * pressure);
      p.rho[k] = rho0 * (1 + Kt * pressure);
      p.mass[k] = p.rho[k] * plane.spacing * row;
    }
  return p;
}

double PlaneFlow::velocity(double z) const { return u_surface * (1 - std::pow(std::max(0.0, 1 - z / height), 1.5)); }

double PlaneFlow::pressure(double z, double grain_density) const {
  return phi * grain_density * earth_gravity * std::cos(angle_deg * M_PI / 180) * std::max(0.0, height - z);
}

PlaneFlow steady_flow(const InclinedPlane& plane, const sph::Model& model) {
  const double theta = plane.angle_deg * M_PI / 180, tangent = std::tan(theta);
  PlaneFlow flow{.phi = model.phi_max(), .height = plane.height, .angle_deg = plane.angle_deg};
  std::visit(
      [&](const auto& rheology, const auto& dilatancy) {
        if (tangent <= rheology.static_friction()) return;
        double hi = 1;
        while (rheology.mu(hi) < tangent) {
          if (hi > 1e6)
            throw UnphysicalError("scenario.angle_deg",
                                  "the slope is steeper than the largest friction: the flow never becomes steady");
          hi *= 2;
        }
        double lo = 0;
        for (int k = 0; k < 200; ++k) (rheology.mu(0.5 * (lo + hi)) < tangent ? lo : hi) = 0.5 * (lo + hi);
        flow.i = 0.5 * (lo + hi);
        flow.phi = dilatancy.phi(flow.i);
      },
      model.material.rheology, model.material.dilatancy);
  flow.u_surface = 2 * flow.i / (3 * model.material.grain_diameter) *
                   std::sqrt(flow.phi * earth_gravity * std::cos(theta)) * std::pow(plane.height, 1.5);
  return flow;
}

std::vector<std::vector<double>> transient_flow(const InclinedPlane& plane, const sph::Model& model, double height,
                                                int cells, const std::vector<double>& times,
                                                double constant_viscosity) {
  const PlaneFlow steady = steady_flow(plane, model);
  const double theta = plane.angle_deg * M_PI / 180, rho_s = model.grains().grain_density, rho = steady.phi * rho_s,
               dz = height / cells, d = model.material.grain_diameter;
  const auto n = static_cast<std::size_t>(cells);
  std::vector<double> u(n, 0.0), next, lower(n), diagonal(n), upper(n), right(n), eta(n + 1, 0.0);
  std::vector<std::vector<double>> results;
  double t = 0;
  for (const double until : times) {
    const auto steps = std::max(1L, std::lround((until - t) / 2e-3));
    const double dt = (until - t) / static_cast<double>(steps);
    for (long s = 0; s < steps; ++s) {
      next = u;
      for (int picard = 0; picard < 8; ++picard) {
        for (std::size_t k = 0; k < n; ++k) {  // face below cell k
          const double p = rho * earth_gravity * std::cos(theta) * (height - static_cast<double>(k) * dz);
          const double gamma = std::abs(k == 0 ? 2 * next[0] : next[k] - next[k - 1]) / dz;
          const double a = d * std::sqrt(rho_s / p);
          std::visit(
              [&](const auto& rheology, const auto& regularisation) {
                eta[k] = constant_viscosity + regularisation.viscosity(rheology.static_friction() * p,
                                                                       p * a * rheology.excess()(gamma * a), gamma);
              },
              model.material.rheology, model.material.regularisation);
        }
        for (std::size_t k = 0; k < n; ++k) {
          const double below = eta[k] * dt / (rho * dz * dz) * (k == 0 ? 2 : 1),
                       above = eta[k + 1] * dt / (rho * dz * dz);
          lower[k] = k == 0 ? 0 : -below;
          upper[k] = -above;
          diagonal[k] = 1 + below + above;
          right[k] = u[k] + dt * earth_gravity * std::sin(theta);
        }
        for (std::size_t k = 1; k < n; ++k) {
          const double ratio = lower[k] / diagonal[k - 1];
          diagonal[k] -= ratio * upper[k - 1];
          right[k] -= ratio * right[k - 1];
        }
        next[n - 1] = right[n - 1] / diagonal[n - 1];
        for (std::size_t k = n - 1; k-- > 0;) next[k] = (right[k] - upper[k] * next[k + 1]) / diagonal[k];
      }
      u = next;
    }
    t = until;
    results.push_back(u);
  }
  return results;
}

}  // namespace bagnold::scenario

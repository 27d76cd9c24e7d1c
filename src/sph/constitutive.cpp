#include "sph/constitutive.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/parallel.hpp"

namespace bagnold::sph {
namespace {

constexpr std::int64_t block = 512;

// Everything the loop needs, as numbers and laws of known type.
template <class Rheology, class Surface, class Dilatancy, class Regularisation, bool bulk_viscosity>
struct Laws {
  static constexpr bool has_bulk = bulk_viscosity;  // of its own: what pair forces contain is nowhere read
  typename Rheology::Excess excess;
  typename Surface::Shape shape;
  Dilatancy dilatancy;
  laws::eos::CompressibleGrains grains;
  Regularisation regularisation;
  double static_friction, d0, bulk, dilatant;
  int dim;
};

// Eight particles: pressure, viscosity and the new root.
template <class L>
void eight(const L& law, const Pack& rho, const Pack& gamma, const Pack& lode, Pack& root, Pack& pressure,
           Pack& viscosity, Pack& bulk) {
  // d/d0 = rho_s*^(-1/D): in 2D it cancels sqrt(rho_s) in i; in 3D rho_s*^(1/6) remains, taken from the last root.
  Pack shear = gamma * law.grains.shear_scale(law.d0);
  if (law.dim == 3)
    for (int k = 0; k < Pack::lanes; ++k) shear.set(k, shear[k] * std::pow(1 + root[k] * root[k], 1.0 / 6));
  const Pack r = rho / (law.grains.grain_density * law.dilatancy.phi_max);
  const auto cubic = law.dilatancy.cubic(r, shear);
  root = laws::eos::largest_root(cubic, root);
  pressure = law.grains.pressure(root);
  // eta0 = p a (mu - mu_s)/i with a = i/gamma, in the form that is finite at rest and at p = 0 (eq. 47).
  const Pack safe = max(root, Pack(1e-12)), a = law.grains.shear_scale(law.d0) / safe;
  const Pack eta0 = pressure * a * law.excess(Pack(gamma * a));
  viscosity = law.regularisation.viscosity(Pack(law.static_friction * pressure), eta0, gamma);
  if constexpr (!decltype(law.shape)::circular)
    for (int k = 0; k < Pack::lanes; ++k) viscosity.set(k, viscosity[k] * law.shape(lode[k]));
  if constexpr (L::has_bulk) {
    // dp/dgamma = 2 p/gamma sensitivity, finite at rest
    const Pack dp = 2 * pressure * laws::eos::sensitivity(cubic, safe) / max(gamma, Pack(1e-12));
    bulk = law.bulk * viscosity + law.dilatant * dp;
  }
}

template <class L>
double sweep(const L& law, Work& w, Particles& p) {
  const std::int64_t n = p.size();
  std::vector<double> largest(static_cast<std::size_t>((n + block - 1) / block));
  parallel_blocks(n, block, [&](std::int64_t begin, std::int64_t end) {
    Pack most{};
    for (std::int64_t i = begin; i < end; i += Pack::lanes) {
      const auto lanes = static_cast<std::size_t>(std::min<std::int64_t>(Pack::lanes, end - i));
      const auto load = [&](const std::vector<double>& a, double fill) {
        Pack v = Pack(fill);
        std::memcpy(&v, a.data() + i, lanes * sizeof(double));
        return v;
      };
      // lanes beyond the last particle are filled with loose material: no pressure, no viscosity
      const Pack rho = load(p.rho, 0.1 * law.grains.grain_density), gamma = load(w.shear_rate, 0);
      Pack root = load(p.root, 0), lode{}, pressure, viscosity, bulk{};
      if constexpr (!decltype(law.shape)::circular) lode = load(w.lode, 0);
      eight(law, rho, gamma, lode, root, pressure, viscosity, bulk);
      std::memcpy(p.root.data() + i, &root, lanes * sizeof(double));
      std::memcpy(w.pressure.data() + i, &pressure, lanes * sizeof(double));
      std::memcpy(w.viscosity.data() + i, &viscosity, lanes * sizeof(double));
      if constexpr (L::has_bulk) std::memcpy(w.bulk.data() + i, &bulk, lanes * sizeof(double));
      most = max(most, Pack(viscosity / rho));
    }
    largest[static_cast<std::size_t>(begin / block)] = bagnold::largest(most);
  });
  double result = 0;
  for (const double value : largest) result = std::max(result, value);
  return result;
}

}  // namespace

double constitutive(Work& w, Particles& p, const Model& model) {
  const Material& m = model.material;
  return std::visit(
      [&](const auto& rheology, const auto& surface, const auto& dilatancy, const auto& grains,
          const auto& regularisation, const auto& viscous) {
        const double mu_s = rheology.static_friction();
        const Laws<std::decay_t<decltype(rheology)>, std::decay_t<decltype(surface)>, std::decay_t<decltype(dilatancy)>,
                   std::decay_t<decltype(regularisation)>, std::decay_t<decltype(viscous)>::corrected>
            law{rheology.excess(), surface.shape(mu_s), dilatancy,        grains,   regularisation, mu_s,
                m.grain_diameter,  viscous.bulk,        viscous.dilatant, model.dim};
        return sweep(law, w, p);
      },
      m.rheology, model.yield_surface(), m.dilatancy, m.eos, m.regularisation, model.viscous);
}

double inertial_number(const Model& model, double gamma, double root) {
  const double shear = gamma * model.grains().shear_scale(model.material.grain_diameter) *
                       (model.dim == 3 ? std::pow(1 + root * root, 1.0 / 6) : 1);
  if (root > 0) return shear / root;
  return gamma > 0 ? std::numeric_limits<double>::infinity() : 0;
}

}  // namespace bagnold::sph

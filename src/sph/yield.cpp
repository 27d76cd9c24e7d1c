#include "sph/yield.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "sph/forces.hpp"

namespace bagnold::sph {

void lower_viscosity(Work& w, const Particles& p, const Model& model, const Field& v) {
  corrected_shear_rate(w, p, model, v);
  std::visit(
      [&](const auto& rheology, const auto& surface, const auto& regularisation) {
        const auto excess = rheology.excess();
        const double bulk = std::visit([](const auto& viscous) { return viscous.bulk; }, model.viscous);
        const double mu_s = rheology.static_friction(), d0 = model.material.grain_diameter;
        const auto shape = surface.shape(mu_s);
        parallel_for(p.size(), [&](std::int64_t k) {
          const auto i = static_cast<std::size_t>(k);
          // eta0 = p a (mu - mu_s)/i with a = i/gamma, finite at rest and at p = 0 (eq. 47)
          const double gamma = w.shear_rate[i],
                       size = model.dim == 3 ? std::pow(1 + p.root[i] * p.root[i], 1.0 / 6) : 1,
                       a = size * model.grains().shear_scale(d0) / std::max(p.root[i], 1e-12),
                       eta0 = w.pressure[i] * a * excess(gamma * a);
          double eta = regularisation.viscosity(mu_s * w.pressure[i], eta0, gamma);
          if constexpr (!decltype(shape)::circular) eta *= shape(w.lode[i]);
          const double change = std::min(eta - w.viscosity[i], 0.0);
          w.bulk[i] += bulk * change;
          w.viscosity[i] += change;
        });
      },
      model.material.rheology, model.yield_surface(), model.material.regularisation);
}

}  // namespace bagnold::sph

#include "sph/yield.hpp"

#include <cmath>
#include <cstring>

#include "core/parallel.hpp"
#include "sph/forces.hpp"

namespace bagnold::sph {
namespace {

struct Dissipation {
  double change = 0, total = 0;
  Dissipation& operator+=(const Dissipation& other) {
    change += other.change, total += other.total;
    return *this;
  }
};

}  // namespace

double reweigh_viscosity(Work& w, const Particles& p, const Model& model) {
  corrected_shear_rate(w, p, model, p.v);
  const Dissipation sum = std::visit(
      [&](const auto& rheology, const auto& surface, const auto& regularisation) {
        const auto excess = rheology.excess();
        const double bulk = std::visit([](const auto& v) { return v.bulk; }, model.viscous);
        const double mu_s = rheology.static_friction(), d0 = model.material.grain_diameter;
        const auto shape = surface.shape(mu_s);
        return parallel_sum<Dissipation>(p.size(), [&](std::int64_t k) {
          const auto i = static_cast<std::size_t>(k);
          // eta0 = p a (mu - mu_s)/i with a = i/gamma, finite at rest and at p = 0 (eq. 47)
          const double gamma = w.shear_rate[i],
                       size = model.dim == 3 ? std::pow(1 + p.root[i] * p.root[i], 1.0 / 6) : 1,
                       a = size * model.grains().shear_scale(d0) / std::max(p.root[i], 1e-12),
                       eta0 = w.pressure[i] * a * excess(gamma * a);
          double eta = regularisation.viscosity(mu_s * w.pressure[i], eta0, gamma);
          if constexpr (!decltype(shape)::circular) eta *= shape(w.lode[i]);
          const double dissipation = gamma * gamma * w.volume[i], change = eta - w.viscosity[i];
          w.bulk[i] += bulk * change;
          w.viscosity[i] = eta;
          return Dissipation{std::abs(change) * dissipation, eta * dissipation};
        });
      },
      model.material.rheology, model.yield_surface(), model.material.regularisation);
  corrected_pressure_and_coefficients(w, p, model);
  return sum.total > 0 ? sum.change / sum.total : 0;
}

}  // namespace bagnold::sph

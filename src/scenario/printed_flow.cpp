#include "scenario/printed_flow.hpp"

#include <cmath>
#include <numeric>

#include "sph/dispatch.hpp"

namespace bagnold::scenario {

OperatorResponse printed_response(const InclinedPlane& plane, const sph::State& state, const sph::Work& w,
                                  const sph::Model& model) {
  const sph::Particles& p = state.particles;
  const auto n = static_cast<std::size_t>(p.size());
  const double h = model.h(), least = 3 * h, most = plane.height - 3 * h;
  OperatorResponse sum;
  double inside = 0;
  sph::dispatch(model, [&](auto dim, const auto& kernel) {
    const sph::PairShape<decltype(dim)::value, std::decay_t<decltype(kernel)>> shape(h);
    for (std::size_t i = 0; i < n; ++i) {
      if (p.x[1][i] < least || p.x[1][i] > most) continue;
      inside += 1;
      for (auto q = w.pairs.offset[i]; q < w.pairs.offset[i + 1]; ++q) {
        auto j = static_cast<std::size_t>(w.pairs.index[static_cast<std::size_t>(q)]);
        const std::size_t image = j - n;
        if (j >= n && image >= w.pairs.images.parent.size()) continue;  // the dummy
        double shift = 0;
        if (j >= n) {
          shift = w.pairs.images.shift[image][0];
          j = static_cast<std::size_t>(w.pairs.images.parent[image]);
        }
        const double x = p.x[0][i] - p.x[0][j] - shift, z = p.x[1][i] - p.x[1][j], r2 = x * x + z * z;
        const double R = shape.ratio(r2, 1 / std::sqrt(r2));
        if (R >= 2) continue;
        const double weight = p.mass[j] / p.rho[j] * shape.f(R);
        sum.stress += 0.5 * laws::viscous::Cleary::coefficient(2) * weight * x * x * z * z / r2;
        sum.gradient += weight * z * z;
      }
    }
  });
  return inside > 0 ? OperatorResponse{sum.stress / inside, sum.gradient / inside} : OperatorResponse{NAN, NAN};
}

double responding_velocity(const InclinedPlane& plane, const sph::Model& model, const OperatorResponse& response,
                           double time) {
  constexpr int cells = 100;
  const auto [a, b] = response;
  auto law = std::get<laws::rheology::MuI>(model.material.rheology);
  for (double* degrees : {&law.static_angle_deg, &law.limit_angle_deg})
    *degrees = std::atan(a / (b * b) * std::tan(*degrees * M_PI / 180)) * 180 / M_PI;
  law.i0 /= std::pow(b, 1.5);
  sph::Model responding = model;
  responding.material.rheology = law;
  const double rho = model.phi_max() * model.grains().grain_density,
               artificial = a * model.numerics.artificial_viscosity * model.h() * model.sound_speed() * rho /
                            laws::viscous::Cleary::coefficient(2);
  const auto u = transient_flow(plane, responding, plane.height, cells, {time}, artificial).front();
  return std::accumulate(u.begin(), u.end(), 0.0) / cells;
}

}  // namespace bagnold::scenario

#include "sph/work.hpp"

namespace bagnold::sph {

void Work::resize(std::int64_t count, int dim) {
  const auto n = static_cast<std::size_t>(count), d = static_cast<std::size_t>(dim);
  for (auto* a : {&volume, &area, &density_rate, &shear_rate, &pressure, &viscosity, &bulk, &coverage, &concentration})
    a->resize(n);
  moment.resize(n * d * d);
  correction.resize(n * d * d);
  gradient.resize(n * d * d);
  wall.resize(n * static_cast<std::size_t>(dim * (dim + 1) / 2));
  preconditioner.resize(n * d * (d + 1) / 2);
  for (Field* field : {&imbalance, &acceleration, &force, &cg_r, &cg_z, &cg_p, &cg_q})
    for (std::size_t c = 0; c < d; ++c) (*field)[c].resize(n);
}

}  // namespace bagnold::sph

// Morris ghost particles under the floor: a fixed lattice of spacing dp, so none is stored.
#pragma once
#include <array>
#include <cmath>

#include "sph/model.hpp"

namespace bagnold::sph {

// f(r, beta) for the ghosts within 2h of a particle at `x`: r = x - x_ghost, v_ij = beta v_i.
// beta = min(beta_max, 1 + d_j/d_i)                                            Minatti & Paris 2015, eqs 34-36
template <int D, class F>
void for_each_ghost(const Model& model, const std::array<double, D>& x, F&& f) {
  const double reach = 2 * model.h(), dp = model.spacing, height = x[D - 1];
  const auto cell = [&](double a) { return static_cast<long>(std::floor(a / dp)); };
  std::array<double, D> r;
  for (long layer = 0; (r[D - 1] = height + (static_cast<double>(layer) + 0.5) * dp) < reach; ++layer) {
    const double beta = height > 0 ? std::min(model.numerics.wall_beta_max, 1 + (r[D - 1] - height) / height)
                                   : model.numerics.wall_beta_max;
    for (long a = cell(x[0] - reach); a <= cell(x[0] + reach); ++a) {
      r[0] = x[0] - (static_cast<double>(a) + 0.5) * dp;
      if constexpr (D == 2) {
        f(r, beta);
      } else {
        for (long b = cell(x[1] - reach); b <= cell(x[1] + reach); ++b) {
          r[1] = x[1] - (static_cast<double>(b) + 0.5) * dp;
          f(r, beta);
        }
      }
    }
  }
}

}  // namespace bagnold::sph

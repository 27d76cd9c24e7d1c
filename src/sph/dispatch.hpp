// Turns run-time choices into compile-time ones, once per sweep and outside every loop.
#pragma once
#include <type_traits>
#include <utility>

#include "sph/model.hpp"

namespace bagnold::sph {

// f(std::integral_constant<int, D>, kernel)
template <class F>
void dispatch(const Model& model, F&& f) {
  std::visit(
      [&](const auto& kernel) {
        if (model.dim == 2)
          f(std::integral_constant<int, 2>{}, kernel);
        else
          f(std::integral_constant<int, 3>{}, kernel);
      },
      model.kernel);
}

// The kernel at a separation of square r2 > 0: f = -W'(r)/r, so that grad_i W = -f r. R = r/h from 1/r.
template <int D, class Kernel>
struct PairShape {
  double inv_h, slope_scale, value_scale, tiny;  // tiny: added to r2, keeps 1/r finite
  explicit PairShape(double h) : inv_h(1 / h), tiny(1e-12 * h * h) {
    double hd = 1;
    for (int k = 0; k < D; ++k) hd *= h;
    value_scale = Kernel::norm(D) / hd;
    slope_scale = value_scale * Kernel::slope_norm / (h * h);
  }
  template <class T>
  T ratio(T r2, T inv_r) const {
    return (r2 * inv_h) * inv_r;
  }
  template <class T>
  T ratio(T r2) const {
    return ieee_sqrt(r2) * inv_h;
  }
  template <class T>
  T f(T R) const {
    return Kernel::slope(T(slope_scale), R);
  }
  template <class T>
  T unscaled_f(T weight, T R) const {  // weight f / slope_scale
    return Kernel::slope(weight, R);
  }
  template <class T>
  T w(T R) const {
    return value_scale * Kernel::value(R);
  }
};

}  // namespace bagnold::sph

// The cubic between bulk density and grain density, and its largest root.
#pragma once
#include "core/numeric.hpp"

namespace bagnold::laws::eos {

// f(y) = y^3 + c2 y^2 + c1 y + c0 with c0 <= 0. Its largest root lies in [lower, bulk + cube root of -c0]; f is convex
// and increasing beyond `lower`.
template <class T>
struct Cubic {
  T c2, c1, c0, lower, bulk;
};

// (s/y) dy/ds at the root y, for c2 and c0 proportional to s and c1 constant: how strongly pressure (y^2) follows shear.
template <class T>
T sensitivity(const Cubic<T>& f, T y) {
  const T slope = (3 * y + 2 * f.c2) * y + f.c1;
  return -(f.c2 * y * y + f.c0) / max(T(slope * y), T(1e-300));
}

// Newton from `guess` (any number). The first step lands right of the root, where convexity makes the rest monotone;
// it is clipped to an upper bound because f' may be tiny at `lower`. Residual of the root: relative 1e-12 of y.
template <class T>
T largest_root(const Cubic<T>& f, T guess) {
  const T root4 = sqrt(T(sqrt(T(-f.c0))));                // >= cube root of -c0 where that is < 1
  const T upper = f.bulk + max(root4, T(root4 * root4));  // root4^2 >= the cube root where it is > 1
  T y = max(min(guess, upper), f.lower);
  for (int iteration = 0; iteration < 60; ++iteration) {
    const T value = ((y + f.c2) * y + f.c1) * y + f.c0;
    const T slope = (3 * y + 2 * f.c2) * y + f.c1;
    const T next = max(min(T(y - value * reciprocal(max(slope, T(1e-300)))), upper), f.lower);
    const T change = max(T(next - y), T(y - next));
    y = next;
    if (!any(T(1e-12 * y + 1e-150) < change)) break;
  }
  return y;
}

}  // namespace bagnold::laws::eos

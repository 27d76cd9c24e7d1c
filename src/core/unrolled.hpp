// A short loop written out at compile time, so that the loop around it vectorises.
#pragma once
#include <utility>

namespace bagnold {

template <int n, class F>
[[gnu::always_inline]] inline void unrolled(F&& f) {
  [&]<int... k>(std::integer_sequence<int, k...>) __attribute__((always_inline)) { (f(k), ...); }
  (std::make_integer_sequence<int, n>{});
}

}  // namespace bagnold

// The state of the shallow layer: mass and momentum per unit area of the bed, row by row with ghost cells.
#pragma once
#include <cstdint>
#include <vector>

#include "core/arrays.hpp"
#include "shallow/definition.hpp"

namespace bagnold::shallow {

struct Conserved {
  std::vector<double> D, Mx, My;  // D = rho h, M = D u
};

// Looks at D, M over a part of the grid whose first entry is cell (i0, j0), whoever owns them.
template <class Number>
struct WindowOf {
  Number *D, *Mx, *My;
  int i0, j0;
  std::int64_t stride;
  std::size_t at(int i, int j) const { return static_cast<std::size_t>((j - j0) * stride + (i - i0)); }
  operator WindowOf<const Number>() const { return {D, Mx, My, i0, j0, stride}; }
};
using Window = WindowOf<double>;
using ConstWindow = WindowOf<const double>;
inline Window window(const Grid& g, Conserved& u) {
  return {u.D.data(), u.Mx.data(), u.My.data(), -halo, -halo, g.stride()};
}
inline ConstWindow window(const Grid& g, const Conserved& u) {
  return {u.D.data(), u.Mx.data(), u.My.data(), -halo, -halo, g.stride()};
}

struct State {
  Conserved now;
  double time = 0, next_step = 0;  // next_step <= 0: not known yet
  std::int64_t step = 0;
  double smallest_step = 0;        // of those not shortened to meet a given time; 0 before the first
  double cell_updates = 0;         // wet cells times steps
  std::vector<double> crossed[4];  // mass that left through each boundary face so far, by Side
};

// Everything an exact checkpoint holds.
inline std::vector<NamedArray> state_arrays(State& s) {
  return {{"D", &s.now.D},
          {"Mx", &s.now.Mx},
          {"My", &s.now.My},
          {"time", &s.time},
          {"next_step", &s.next_step},
          {"step", &s.step},
          {"smallest_step", &s.smallest_step},
          {"cell_updates", &s.cell_updates},
          {"crossed_left", &s.crossed[0]},
          {"crossed_right", &s.crossed[1]},
          {"crossed_bottom", &s.crossed[2]},
          {"crossed_top", &s.crossed[3]}};
}

}  // namespace bagnold::shallow

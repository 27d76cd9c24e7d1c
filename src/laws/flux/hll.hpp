// The two-wave flux of Harten, Lax & van Leer for depth-averaged flow with shape factor and stress ratio.
#pragma once
#include "core/numeric.hpp"

namespace bagnold::laws {

// One side of a face. h: thickness, un and ut: depth-averaged velocity normal and tangential to the face. N: double, or a
// pack of numbers.
template <class N>
struct ShallowSide {
  N h, un, ut;
};
// Closures at the face, common to both sides. gK = K g cos(theta); slope = h d(alpha)/dh, not negative.
template <class N>
struct ShallowFace {
  N rho, alpha, gK, slope;
};
template <class N>
struct ShallowFlux {
  N mass, normal, tangential;  // of rho h, of rho h un (pressure included), of rho h ut
  N speed;                     // largest |characteristic speed|
};

// Square of half the distance of the characteristics of eq. 34 at constant rho, K:
// alpha u +- sqrt((alpha (alpha - 1) + h alpha') u^2 + K g cos(theta) h).
template <class N>
[[gnu::always_inline]] inline N squared_width(const ShallowFace<N>& f, const N& h, const N& u) {
  return (f.alpha * (f.alpha - 1.0) + f.slope) * (u * u) + f.gK * h;
}

// Bounds of the waves take the larger width of both sides: one square root a face. Next to a dry state the front runs at
// alpha u + 2 sqrt(K g cos(theta) h) (Toro 2001, section 6.3). The tangential momentum is carried by the mass flux (contact
// wave at alpha u). Commutes with exchanging the sides bit for bit.
template <class N>
[[gnu::always_inline]] inline ShallowFlux<N> hll(const ShallowFace<N>& f, const ShallowSide<N>& l,
                                                 const ShallowSide<N>& r) {
  const N zero = 0.0;
  const N width = ieee_sqrt(max(squared_width(f, l.h, l.un), squared_width(f, r.h, r.un)));
  const N al = f.alpha * l.un, ar = f.alpha * r.un;
  const auto wet_l = l.h > zero, wet_r = r.h > zero;
  const N slowest = select(wet_l, select(wet_r, min(al, ar), al), ar - width),
          fastest = select(wet_r, select(wet_l, max(al, ar), ar), al + width);
  const N sl = min(slowest - width, zero), sr = max(fastest + width, zero);
  const N span = sr - sl, inv = select(span > zero, 1.0 / span, zero);
  const N dl = f.rho * l.h, dr = f.rho * r.h, ml = dl * l.un, mr = dr * r.un, half_gK = 0.5 * f.gK;
  const N fl = al * ml + half_gK * dl * l.h, fr = ar * mr + half_gK * dr * r.h, both = sl * sr;
  const N mass = ((sr * ml - sl * mr) + both * (dr - dl)) * inv;
  const N normal = ((sr * fl - sl * fr) + both * (mr - ml)) * inv;
  const N carried = select(mass > zero, l.ut, r.ut);
  return {mass, normal, f.alpha * mass * carried, max(sr, zero - sl)};
}

}  // namespace bagnold::laws

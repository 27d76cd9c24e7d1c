// The two-wave flux of Harten, Lax & van Leer for depth-averaged flow with shape factor and stress ratio.
#pragma once
#include <cmath>

namespace bagnold::laws {

// One side of a face. h: thickness, un and ut: depth-averaged velocity normal and tangential to the face.
struct ShallowSide {
  double h, un, ut;
};
// Closures at the face, common to both sides. gK = K g cos(theta); slope = h d(alpha)/dh, not negative.
struct ShallowFace {
  double rho, alpha, gK, slope;
};
struct ShallowFlux {
  double mass, normal, tangential;  // of rho h, of rho h un (pressure included), of rho h ut
  double speed;                     // largest |characteristic speed|
};

// Characteristics of eq. 34 at constant rho, K: alpha u +- sqrt((alpha (alpha - 1) + h alpha') u^2 + K g cos(theta) h).
inline double characteristic_width(const ShallowFace& f, double h, double u) {
  return std::sqrt((f.alpha * (f.alpha - 1) + f.slope) * (u * u) + f.gK * h);
}

// Next to a dry state the front runs at alpha u + 2 sqrt(K g cos(theta) h) (Toro 2001, section 6.3). The tangential
// momentum is carried by the mass flux (contact wave at alpha u). Commutes with exchanging the sides bit for bit.
inline ShallowFlux hll(const ShallowFace& f, const ShallowSide& l, const ShallowSide& r) {
  const double wl = characteristic_width(f, l.h, l.un), wr = characteristic_width(f, r.h, r.un);
  const double al = f.alpha * l.un, ar = f.alpha * r.un;
  const bool dry_l = !(l.h > 0), dry_r = !(r.h > 0);
  double sl = al - wl < ar - wr ? al - wl : ar - wr, sr = al + wl > ar + wr ? al + wl : ar + wr;
  sr = dry_r ? al + 2 * wl : sr;
  sl = dry_r ? al - wl : sl;
  sl = dry_l ? ar - 2 * wr : sl;
  sr = dry_l ? ar + wr : sr;
  sl = sl < 0 ? sl : 0;
  sr = sr > 0 ? sr : 0;
  const double span = sr - sl, inv = span > 0 ? 1 / span : 0;
  const double dl = f.rho * l.h, dr = f.rho * r.h, ml = dl * l.un, mr = dr * r.un;
  const double fl = al * ml + 0.5 * f.gK * dl * l.h, fr = ar * mr + 0.5 * f.gK * dr * r.h;
  const double mass = ((sr * ml - sl * mr) + sl * sr * (dr - dl)) * inv;
  const double normal = ((sr * fl - sl * fr) + sl * sr * (mr - ml)) * inv;
  const double carried = mass > 0 ? l.ut : r.ut;
  return {mass, normal, f.alpha * mass * carried, sr > -sl ? sr : -sl};
}

}  // namespace bagnold::laws

// Everything two touching bodies do to each other, in the order of the paper: geometry, slip, advance of the
// springs, Coulomb cut, forces and torques. Written once for any number type, so that every kernel shares it.
// Weinhart et al. 2012, eqs 1-9 and algorithms 1, 2; the spin terms of the slip follow from the surface velocity
// v + omega x b (the print has them with the opposite sign).
#pragma once
#include "core/numeric.hpp"
#include "laws/contact/response.hpp"

namespace bagnold::laws {

// Motion of body i relative to body j. For a plane, j has radius 0 and r points from the foot of the perpendicular to
// the centre of i. EqualRadii: all bodies have the same, and `spin_difference` and `size_difference` are not read
// unless they roll.
template <class N, bool EqualRadii = false>
struct PairMotion {
  Vec3Of<N> r, v;                       // r_i - r_j, v_i - v_j
  Vec3Of<N> spin_sum, spin_difference;  // omega_i + omega_j, omega_i - omega_j
  N reach, size_difference;             // r_i + r_j, r_i - r_j
  N turns;                              // 1: the normal turns with the pair; 0: it is that of a plane
};

template <class N>
struct PairGeometry {
  Vec3Of<N> n, v, slip, spin;  // unit normal from j to i; v_ij; slip velocity v^t; relative rolling velocity
  Vec3Of<N> arm_i, arm_j;      // -b_ij, b_ji: from the contact point to the centre of i, from that of j to it
  N overlap, vn, turn_rate;    // delta_n; v_ij . n; 1/|r_ij|, 0 at a plane
};

// What the contact remembers.
template <class N>
struct PairHistory {
  Vec3Of<N> spring, roll;  // tangential displacement delta_t, rolling angle; both 0 when the contact forms
};

template <class N>
struct PairForce {
  Vec3Of<N> force, torque_i, torque_j;         // force on i (minus that on j), torques about the centres
  N normal;                                    // f^n = normal * n
  N normal_damping;                            // dashpot part of `normal`
  Vec3Of<N> tangential_damping, roll_damping;  // dashpot parts of the tangential force and of the rolling torque
  N tangential_stiffness, roll_stiffness;
  N slide_loss, roll_loss;  // spring energy the sliders took while the springs were advanced
};

template <class Normal, class Tangential, class Rolling>
struct PairLaw {
  Normal normal;
  Tangential tangential;
  Rolling rolling;
};

// The arms are -b_ij = (|r| + r_i - r_j)/2 n and b_ji = (|r| - r_i + r_j)/2 n: the contact point lies halfway between
// the surfaces. So the spin terms of the slip are omega_i x (-b_ij) + omega_j x b_ji
// = (omega_i + omega_j) x r/2 + (omega_i - omega_j) x (r_i - r_j)/2 n. What does not wait for the root comes first.
template <class N, bool EqualRadii>
PairGeometry<N> pair_geometry(const PairMotion<N, EqualRadii>& m) {
  const Vec3Of<N> half = N(0.5) * m.r;
  const Vec3Of<N> surface = m.v - cross(m.spin_sum, half);
  const N distance2 = dot(m.r, m.r), inverse = rsqrt(distance2);
  PairGeometry<N> g;
  g.n = inverse * m.r;
  g.v = m.v;
  g.overlap = m.reach - distance2 * inverse;
  g.vn = dot(m.v, m.r) * inverse;
  g.turn_rate = m.turns * inverse;
  g.arm_i = {half.x, half.y, half.z};  // number by number: g++ 12 keeps the memory of a copy in one piece
  g.arm_j = {half.x, half.y, half.z};
  g.slip = surface - g.vn * g.n;
  if constexpr (!EqualRadii) {
    const Vec3Of<N> shift = (N(0.5) * m.size_difference) * g.n;
    g.slip = g.slip - cross(m.spin_difference, shift);
    g.arm_i = half + shift;
    g.arm_j = half - shift;
  }
  g.spin = m.spin_difference - dot(m.spin_difference, g.n) * g.n;
  return g;
}

// Eq. 9: the spring turns with the pair and stretches by the rate.
template <class N>
Vec3Of<N> turned(const Vec3Of<N>& spring, const PairGeometry<N>& g, N dt) {
  return spring - (dt * dot(spring, g.v) * g.turn_rate) * g.n;
}
template <class N>
Vec3Of<N> stretched(const Vec3Of<N>& spring, const Vec3Of<N>& rate, const PairGeometry<N>& g, N dt) {
  return turned(spring, g, dt) + dt * rate;
}

// Tangent stiffness of the normal law a step ago over that of now. The drift is linear, so the overlap then was
// overlap + v_n dt up to the turning of the pair.
template <class N, class Normal>
N earlier_stiffness(const Normal& law, const PairGeometry<N>& g, N dt) {
  return law.stiffness_ratio(max(N(0), g.overlap + dt * g.vn), g.overlap);
}

// A spring of stiffness `now` that was `earlier` times as stiff a step ago: its force is kept while the stiffness grows,
// its length while it falls, so no energy appears.
template <class N>
N rescaling(N earlier) {
  return min(N(1), earlier);
}
// The energy it gives up by that.
template <class N>
N rescaling_loss(const Vec3Of<N>& spring, N earlier, N now) {
  const N factor = rescaling(earlier);
  return N(0.5) * now * dot(spring, spring) * (earlier - factor * factor);
}

// Energy a slider takes that cuts a spring from `trial` to `cut`: the mean force over the step (its energy at half-step
// velocities changes by exactly that), times the slip.
template <class N>
N slip_loss(N stiffness, const Vec3Of<N>& before, const Vec3Of<N>& trial, const Vec3Of<N>& cut) {
  return N(0.5) * stiffness * dot(before + cut, trial - cut);
}

// Tangential part, algorithm 2. Advance: the springs move on by dt; otherwise the history is only read.
template <bool Advance, class N, class Normal, class Tangential, class Rolling>
void add_tangential(const PairLaw<Normal, Tangential, Rolling>& law, const PairGeometry<N>& g,
                    const NormalResponse<N>& normal, N dt, PairHistory<N>& history, PairForce<N>& out) {
  const N kt = law.tangential.stiffness(normal), gamma = law.tangential.damping(normal);
  Vec3Of<N>& spring = history.spring;
  Vec3Of<N> before = spring;
  if constexpr (Advance) {
    if constexpr (!Normal::constant_stiffness && !Tangential::constant_stiffness) {
      const N earlier = earlier_stiffness(law.normal, g, dt);
      out.slide_loss = out.slide_loss + rescaling_loss(spring, earlier, kt);
      before = rescaling(earlier) * spring;
      spring =
          rescaling(earlier) * turned(spring, g, dt) + dt * g.slip;  // turned first: that need not wait for the roots
    } else {
      spring = stretched(spring, g.slip, g, dt);
    }
  }
  const Vec3Of<N> dashpot = gamma * g.slip;
  Vec3Of<N> pull = kt * spring + dashpot;  // minus the tangential force
  const N limit = law.tangential.mu * abs(out.normal), trial2 = dot(pull, pull);
  const auto slides = trial2 > limit * limit;
  if (worthwhile(slides)) {
    pull = select(slides, limit * rsqrt(trial2), N(1)) * pull;
    if constexpr (Advance) {
      const N inverse = select(kt > N(0), N(1) / kt, N(0));
      const Vec3Of<N> cut = inverse * (pull - dashpot);
      out.slide_loss = out.slide_loss + select(slides, slip_loss(kt, before, spring, cut), N(0));
      spring = select(slides, cut, spring);
    }
  }
  out.tangential_stiffness = kt;
  out.tangential_damping = kt * spring - pull;
  out.force = out.force - pull;
  out.torque_i = cross(g.arm_i, pull);
  out.torque_j = cross(g.arm_j, pull);
}

// Rolling part, Ai et al. 2011, model C.
template <bool Advance, class N, class Normal, class Tangential, class Rolling>
void add_rolling(const PairLaw<Normal, Tangential, Rolling>& law, const PairGeometry<N>& g, const PairSize<N>& size,
                 const NormalResponse<N>& normal, N dt, PairHistory<N>& history, PairForce<N>& out) {
  const N kr = law.rolling.stiffness(normal, size), cr = law.rolling.damping(kr, size);
  Vec3Of<N>& roll = history.roll;
  Vec3Of<N> before = roll;
  if constexpr (Advance) {
    if constexpr (!Normal::constant_stiffness) {
      const N earlier = earlier_stiffness(law.normal, g, dt);
      out.roll_loss = out.roll_loss + rescaling_loss(roll, earlier, kr);
      before = rescaling(earlier) * roll;
      roll = rescaling(earlier) * turned(roll, g, dt) + dt * g.spin;
    } else {
      roll = stretched(roll, g.spin, g, dt);
    }
  }
  const N limit = law.rolling.limit(out.normal, size), trial2 = kr * kr * dot(roll, roll);
  // A spring at its limit slides, also when it is read again after having been cut to it, by a function that rounds the
  // overlap of a grazing contact another way.
  const auto slides = trial2 > N(1 - 1e-9) * limit * limit;
  if (worthwhile(slides)) {
    const Vec3Of<N> cut = select(slides, limit * rsqrt(trial2), N(1)) * roll;
    if constexpr (Advance) {
      out.roll_loss = out.roll_loss + slip_loss(kr, before, roll, cut);
      roll = cut;
    }
  }
  out.roll_stiffness = kr;
  out.roll_damping = select(slides, N(0), N(0) - cr) * g.spin;
  const Vec3Of<N> torque = out.roll_damping - kr * roll;
  out.torque_i = out.torque_i + torque;
  out.torque_j = out.torque_j - torque;
}

// The interaction of a touching pair (overlap > 0).
template <bool Advance, class N, class Normal, class Tangential, class Rolling>
PairForce<N> interact(const PairLaw<Normal, Tangential, Rolling>& law, const PairGeometry<N>& g,
                      const PairSize<N>& size, N dt, PairHistory<N>& history) {
  PairForce<N> out{};
  const NormalResponse<N> normal = law.normal.respond(g.overlap, size);
  out.normal_damping = N(0) - normal.damping * g.vn;
  out.normal = normal.elastic + out.normal_damping;
  out.force = out.normal * g.n;
  add_tangential<Advance>(law, g, normal, dt, history, out);
  if constexpr (Rolling::active) add_rolling<Advance>(law, g, size, normal, dt, history, out);
  return out;
}

// Energy lost with the springs of a pair that touched a step ago and no longer does: a last stretch, then all is cut.
template <class N, class Normal, class Tangential, class Rolling>
N energy_left(const PairLaw<Normal, Tangential, Rolling>& law, const PairGeometry<N>& g, const PairSize<N>& size,
              const PairHistory<N>& history, N dt) {
  const NormalResponse<N> normal = law.normal.respond(max(N(0), g.overlap + dt * g.vn), size);
  const Vec3Of<N> nothing{N(0), N(0), N(0)};
  N energy =
      slip_loss(law.tangential.stiffness(normal), history.spring, stretched(history.spring, g.slip, g, dt), nothing);
  if constexpr (Rolling::active)
    energy = energy + slip_loss(law.rolling.stiffness(normal, size), history.roll,
                                stretched(history.roll, g.spin, g, dt), nothing);
  return energy;
}

}  // namespace bagnold::laws

// Which pairs are looked at. Three lists, each selected from the one before and far shorter: outer (all pairs within a
// skin, some hundred steps), mid (tens of steps), inner (a few steps; the pairs the force kernel sees).
//
// Why no contact is missed. Positions move by x' = x + dt v', v' = v + dt a. Let a grain be at x with velocity v when a
// list is made, and let A_1, A_2, ... bound its acceleration in the steps after. After k steps its distance from the
// straight path x + k dt v is at most B_k, where W_k = W_(k-1) + dt A_k and B_k = B_(k-1) + dt W_k (Drift). A pair at r
// with relative velocity v is then, for any time tau <= T on its path, at least
//   |r + tau v| - B_i - B_j >= sqrt(r^2 + 2 T min(0, r.v)) - B_i - B_j     (since |r + tau v|^2 >= r^2 + 2 tau r.v)
// apart. A pair with r^2 + 2 T min(0, r.v) >= (reach + margin)^2 therefore cannot touch while T has not passed and
// B_i + B_j <= margin. Nothing is predicted: A is the largest acceleration met in the grain's slab, B is summed as the
// steps are taken, and Validity is tested before every use of a list; a list that no longer holds is made anew at
// the present positions, so the margin is only a guess at what is economical.
//
// The outer list holds while every grain has moved by at most skin/2 relative to a common moving frame (Audit).
//
// Lists never change results: the pairs of a list are always in the order of the outer list, and a pair that does
// not touch adds exactly nothing.
#pragma once
#include <cstdint>
#include <vector>

#include "core/box.hpp"
#include "dem/fast/rows.hpp"

namespace bagnold::dem::fast {

// Bound on the distance from the straight path.
struct Drift {
  double speed = 0, distance = 0;
  void step(double dt, double acceleration) {
    speed += dt * acceleration;
    distance += dt * speed;
  }
  // After `steps` more steps of that acceleration.
  double after(int steps, double dt, double acceleration) const {
    return distance + steps * dt * speed + 0.5 * steps * (steps + 1) * dt * dt * acceleration;
  }
};

struct Validity {
  std::int64_t steps_left = -1;
  double margin = 0;
  Drift a, b;  // of the two slabs the pairs belong to
  void renew(int steps, double new_margin) { *this = {steps, new_margin, {}, {}}; }
  void step(double dt, double acceleration_a, double acceleration_b) {
    --steps_left;
    a.step(dt, acceleration_a);
    b.step(dt, acceleration_b);
  }
  // False when an acceleration was not a number. The last 1e-3 of the margin covers rounding.
  bool holds() const { return steps_left >= 0 && a.distance + b.distance <= 0.999 * margin; }
};

// The box as the kernel folds separations into it: 0 where it does not repeat.
struct Images {
  Vec3 length, inverse;
};

struct PairSpan {
  const Offset *i, *j;       // readable up to the next multiple of eight
  const std::uint32_t* key;  // place in the outer list of the section; nullptr: 0, 1, 2, ...
  std::size_t count;
};

struct Selection {
  Aligned<Offset> i, j;
  Aligned<std::uint32_t> key;
  std::size_t count = 0;
  PairSpan span() const { return {i.data(), j.data(), key.data(), count}; }
  void reserve(std::size_t n) {
    if (i.size() >= n + 16) return;
    const std::size_t room = n + n / 4 + 16;
    i.resize(room);
    j.resize(room);
    key.resize(room);
  }
  // Fills up to a multiple of `lanes` with a pair that never touches.
  void pad(std::size_t lanes, Offset pad_i, Offset pad_j, std::uint32_t pad_key);
};

// The pairs that may come within reach + margin on their straight paths in the time `horizon`, or were so in the time
// `before` now.
void select(const Rows& rows, const Images& images, const PairSpan& from, double horizon, double before, double margin,
            Selection& out);

// r folded to the nearest image.
template <class N>
Vec3Of<N> fold(const Images& images, const Vec3Of<N>& r) {
  return {r.x - N(images.length.x) * nearest_integer(N(images.inverse.x) * r.x),
          r.y - N(images.length.y) * nearest_integer(N(images.inverse.y) * r.y),
          r.z - N(images.length.z) * nearest_integer(N(images.inverse.z) * r.z)};
}

// Largest distance, now or `horizon` later on straight paths, of the grains [begin, end) from where they started,
// relative to a frame that has moved by `frame_path` at `frame_velocity`. Infinite when anything is not a number.
double largest_excursion(const Rows& rows, const std::vector<Vec3>& start, std::size_t begin, std::size_t end,
                         const Vec3& frame_path, const Vec3& frame_velocity, double horizon);

}  // namespace bagnold::dem::fast

#include "dem/fast/lists.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

void Selection::pad(std::size_t lanes, Offset pad_i, Offset pad_j, std::uint32_t pad_key) {
  for (std::size_t k = count; k < (count + lanes - 1) / lanes * lanes; ++k) {
    i[k] = pad_i;
    j[k] = pad_j;
    key[k] = pad_key;
  }
}

namespace {

template <bool looks_back>
void select(const Rows& rows, const Images& images, const PairSpan& from, double horizon, double before, double margin,
            Selection& out) {
  const Lanes twice_horizon = 2 * horizon, twice_before = 2 * before, zero = 0.0, extra = margin;
  alignas(32) std::uint32_t key[8];
  out.reserve(from.count);
  // The compiler is told that what is written is nothing that is read, or it would read everything again every time.
  const Images box = images;
  const double* __restrict position = rows.position.data(), * __restrict velocity = rows.velocity.data();
  const Offset* __restrict i = from.i, * __restrict j = from.j;
  const std::uint32_t* __restrict from_key = from.key;
  Offset* __restrict out_i = out.i.data(), * __restrict out_j = out.j.data();
  std::uint32_t* __restrict out_key = out.key.data();
  const std::size_t pairs = from.count;
  std::size_t count = 0;
  for (std::size_t p = 0; p < pairs; p += 8) {
    const Separation s = separation(position, i + p, j + p);
    const Vec3Of<Lanes> v = difference(velocity, i + p, j + p, 0).xyz;
    const Vec3Of<Lanes> r = fold(box, s.r);
    const Lanes near = s.reach + extra;
    Lanes nearest2 = dot(r, r) + twice_horizon * min(dot(r, v), zero);
    if constexpr (looks_back) nearest2 -= twice_before * max(dot(r, v), zero);
    std::uint32_t bits = to_integer(nearest2 < near * near);
    if (pairs - p < 8) bits &= (1u << (pairs - p)) - 1;
    if (from_key == nullptr)
      for (std::uint32_t k = 0; k < 8; ++k) key[k] = static_cast<std::uint32_t>(p) + k;
    compress(bits, i + p, out_i + count);
    compress(bits, j + p, out_j + count);
    count += static_cast<std::size_t>(compress(bits, from_key == nullptr ? key : from_key + p, out_key + count));
  }
  out.count = count;
}

}  // namespace

void select(const Rows& rows, const Images& images, const PairSpan& from, double horizon, double before, double margin,
            Selection& out) {
  before > 0 ? select<true>(rows, images, from, horizon, before, margin, out)
             : select<false>(rows, images, from, horizon, before, margin, out);
}

double largest_excursion(const Rows& rows, const std::vector<Vec3>& start, std::size_t begin, std::size_t end,
                         const Vec3& frame_path, const Vec3& frame_velocity, double horizon) {
  double largest2 = 0;
  bool finite = true;
  for (std::size_t k = begin; k < end; ++k) {
    const double *x = &rows.position[position_doubles * k], *v = &rows.velocity[velocity_doubles * k];
    const Vec3 moved = Vec3{x[0], x[1], x[2]} - start[k] - frame_path;
    const Vec3 later = moved + horizon * (Vec3{v[0], v[1], v[2]} - frame_velocity);
    const double now2 = norm2(moved), later2 = norm2(later);
    largest2 = std::max(largest2, std::max(now2, later2));
    finite = finite && now2 + later2 < std::numeric_limits<double>::max();
  }
  return finite ? std::sqrt(largest2) : std::numeric_limits<double>::infinity();
}

}  // namespace bagnold::dem::fast

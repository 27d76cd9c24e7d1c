// The grains as the fast kernel keeps them: three rows each, sorted in space. A row is one or half a cache line, so
// that eight pairs are fetched with eight loads a side and turned into packs by transposing registers.
//
//   position  { x, y, z,  radius }
//   velocity  { v,  radius,        omega,  1/m }     at half steps
//   force     { f,  1/m,           torque, 1/I }     what a step needs to kick is in the row it kicks with
//
// 1/m and 1/I of a fixed grain are 0. The constants sit where sums over pairs need them: differences of the first
// half and sums of the second half of two velocity rows give v_ij, r_i - r_j, omega_i + omega_j, 1/m_i + 1/m_j.
// Lists name a grain by the byte offset of its position row; velocity and force rows are twice as far.
#pragma once
#include <cstddef>
#include <cstdint>
#include <new>
#include <utility>
#include <vector>

#include "core/numeric.hpp"
#include "core/simd.hpp"

namespace bagnold::dem::fast {

using Lanes = Pack;

// Memory that starts at a cache line; resize() leaves new numbers as they are: pages nobody writes cost nothing.
template <class T>
struct CacheAligned {
  using value_type = T;
  static constexpr std::align_val_t line{64};
  CacheAligned() = default;
  template <class U>
  CacheAligned(const CacheAligned<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), line)); }
  template <class U>
  void construct(U* p) {
    ::new (static_cast<void*>(p)) U;
  }
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }
  void deallocate(T* p, std::size_t) { ::operator delete(p, line); }
  friend bool operator==(const CacheAligned&, const CacheAligned&) { return true; }
};
template <class T>
using Aligned = std::vector<T, CacheAligned<T>>;

using Offset = std::uint32_t;
constexpr std::size_t position_doubles = 4, velocity_doubles = 8, force_doubles = 8;
constexpr Offset offset_of(std::size_t row) { return static_cast<Offset>(row * position_doubles * sizeof(double)); }
constexpr std::size_t row_of(Offset offset) { return offset / (position_doubles * sizeof(double)); }

struct Rows {
  Aligned<double> position, velocity, force;
  std::size_t size() const { return position.size() / position_doubles; }
};

inline const double* row_at(const double* rows, std::size_t bytes) {
  return reinterpret_cast<const double*>(reinterpret_cast<const char*>(rows) + bytes);
}
inline double* row_at(double* rows, std::size_t bytes) {
  return reinterpret_cast<double*>(reinterpret_cast<char*>(rows) + bytes);
}

// What eight pairs need of their rows.
struct RowDifference {
  Vec3Of<Lanes> xyz;
  Lanes fourth;
};
struct Separation {
  Vec3Of<Lanes> r;  // x_i - x_j
  Lanes reach;      // r_i + r_j
};
struct RelativeMotion {
  Vec3Of<Lanes> v, spin_sum;            // v_i - v_j, omega_i + omega_j
  Lanes size_difference, inverse_mass;  // r_i - r_j, 1/m_i + 1/m_j
};

namespace detail {

inline const double* velocity_at(const double* velocity, Offset offset) {
  return row_at(velocity, 2 * std::size_t{offset});
}
inline double* force_at(double* force, Offset offset) { return row_at(force, 2 * std::size_t{offset}); }

// out[c]: number c of rows 0 .. 7, of which row(k) gives four numbers.
template <class Row>
[[gnu::always_inline]] inline void columns4(Row&& row, Register (&out)[4]) {
  const Register pair[4] = {row(0), row(1), row(2), row(3)};
  simd::transpose4(pair, out);
}

// Pair after pair, so that a grain may appear in several lanes.
[[gnu::always_inline]] inline void add_pair(double* on_i, double* on_j, Register row_i, Register row_j) {
  simd::store(on_i, simd::load_eight(on_i) + row_i);
  simd::store(on_j, simd::subtract_then_add(simd::load_eight(on_j), row_j));  // -f, +torque
}

}  // namespace detail

inline Separation separation(const double* position, const Offset* i, const Offset* j) {
  const Register sign = simd::eight(-1, -1, -1, 1, -1, -1, -1, 1);
  const auto two = [&](const Offset* o, int k) {
    return simd::halves(simd::load_four(row_at(position, o[k])), simd::load_four(row_at(position, o[k + 4])));
  };
  Register out[4];
  detail::columns4([&](int k) { return two(j, k) * sign + two(i, k); }, out);
  return {{Lanes(out[0]), Lanes(out[1]), Lanes(out[2])}, Lanes(out[3])};
}

inline RelativeMotion relative_motion(const double* velocity, const Offset* i, const Offset* j) {
  Register row[8], out[8];
  for (int k = 0; k < 8; ++k)
    row[k] = simd::subtract_then_add(simd::load_eight(detail::velocity_at(velocity, i[k])),
                                     simd::load_eight(detail::velocity_at(velocity, j[k])));
  simd::transpose8(row, out);
  return {{Lanes(out[0]), Lanes(out[1]), Lanes(out[2])},
          {Lanes(out[4]), Lanes(out[5]), Lanes(out[6])},
          Lanes(out[3]),
          Lanes(out[7])};
}

// Half a row: v_i - v_j and r_i - r_j (first = 0), or omega_i - omega_j and 1/m_i - 1/m_j (first = 4).
inline RowDifference difference(const double* velocity, const Offset* i, const Offset* j, std::size_t first) {
  const auto two = [&](const Offset* o, int k) {
    return simd::halves(simd::load_four(detail::velocity_at(velocity, o[k]) + first),
                        simd::load_four(detail::velocity_at(velocity, o[k + 4]) + first));
  };
  Register out[4];
  detail::columns4([&](int k) { return two(i, k) - two(j, k); }, out);
  return {{Lanes(out[0]), Lanes(out[1]), Lanes(out[2])}, Lanes(out[3])};
}

// Adds force and torque to the rows.
inline void add_to_rows(double* force, const Offset* i, const Offset* j, const Vec3Of<Lanes>& f,
                        const Vec3Of<Lanes>& torque) {
  const Register zero = simd::eight(0.0);
  const Register column[8] = {f.x.v, f.y.v, f.z.v, zero, torque.x.v, torque.y.v, torque.z.v, zero};
  Register row[8];
  simd::transpose8(column, row);
  for (int k = 0; k < 8; ++k)
    detail::add_pair(detail::force_at(force, i[k]), detail::force_at(force, j[k]), row[k], row[k]);
}

// The same with another torque on j.
inline void add_to_rows(double* force, const Offset* i, const Offset* j, const Vec3Of<Lanes>& f,
                        const Vec3Of<Lanes>& torque_i, const Vec3Of<Lanes>& torque_j) {
  const Register zero = simd::eight(0.0);
  const Register on_i[8] = {f.x.v, f.y.v, f.z.v, zero, torque_i.x.v, torque_i.y.v, torque_i.z.v, zero};
  const Register on_j[8] = {f.x.v, f.y.v, f.z.v, zero, torque_j.x.v, torque_j.y.v, torque_j.z.v, zero};
  Register row_i[8], row_j[8];
  simd::transpose8(on_i, row_i);
  simd::transpose8(on_j, row_j);
  for (int k = 0; k < 8; ++k)
    detail::add_pair(detail::force_at(force, i[k]), detail::force_at(force, j[k]), row_i[k], row_j[k]);
}

}  // namespace bagnold::dem::fast

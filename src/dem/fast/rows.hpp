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

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

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

#ifdef BAGNOLD_AVX512

namespace detail {

// Halves of two rows: [a | b].
inline Register halves(const double* a, const double* b) {
  return __builtin_shufflevector(_mm256_load_pd(a), _mm256_load_pd(b), 0, 1, 2, 3, 4, 5, 6, 7);
}

inline Register evens(Register a, Register b) { return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14); }
inline Register odds(Register a, Register b) { return __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15); }

// Register k holds the four numbers of pair k and those of pair k + 4; out[c] holds number c of pairs 0..7.
inline void transpose4(const Register (&row)[4], Register (&out)[4]) {
  const Register even01 = evens(row[0], row[1]), even23 = evens(row[2], row[3]);
  const Register odd01 = odds(row[0], row[1]), odd23 = odds(row[2], row[3]);
  out[0] = __builtin_shufflevector(even01, even23, 0, 1, 8, 9, 4, 5, 12, 13);
  out[1] = __builtin_shufflevector(odd01, odd23, 0, 1, 8, 9, 4, 5, 12, 13);
  out[2] = __builtin_shufflevector(even01, even23, 2, 3, 10, 11, 6, 7, 14, 15);
  out[3] = __builtin_shufflevector(odd01, odd23, 2, 3, 10, 11, 6, 7, 14, 15);
}

// Eight rows of eight: out[c] holds number c of rows 0..7.
inline void transpose8(const Register (&row)[8], Register (&out)[8]) {
  for (int parity = 0; parity < 2; ++parity) {
    Register pair[4];
    for (int k = 0; k < 4; ++k)
      pair[k] = parity == 0 ? evens(row[2 * k], row[2 * k + 1]) : odds(row[2 * k], row[2 * k + 1]);
    const Register a = __builtin_shufflevector(pair[0], pair[1], 0, 1, 8, 9, 2, 3, 10, 11);
    const Register b = __builtin_shufflevector(pair[2], pair[3], 0, 1, 8, 9, 2, 3, 10, 11);
    const Register c = __builtin_shufflevector(pair[0], pair[1], 4, 5, 12, 13, 6, 7, 14, 15);
    const Register d = __builtin_shufflevector(pair[2], pair[3], 4, 5, 12, 13, 6, 7, 14, 15);
    out[parity] = __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11);
    out[parity + 2] = __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15);
    out[parity + 4] = __builtin_shufflevector(c, d, 0, 1, 2, 3, 8, 9, 10, 11);
    out[parity + 6] = __builtin_shufflevector(c, d, 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

// -1 for the numbers that are subtracted, 1 for those that are added.
inline Register subtract_then_add() { return _mm512_setr_pd(-1, -1, -1, -1, 1, 1, 1, 1); }

}  // namespace detail

inline Separation separation(const double* position, const Offset* i, const Offset* j) {
  const Register sign = _mm512_setr_pd(-1, -1, -1, 1, -1, -1, -1, 1);
  Register row[4], out[4];
  for (int k = 0; k < 4; ++k)
    row[k] = detail::halves(row_at(position, j[k]), row_at(position, j[k + 4])) * sign +
             detail::halves(row_at(position, i[k]), row_at(position, i[k + 4]));
  detail::transpose4(row, out);
  Separation s;
  s.r.x.v = out[0];
  s.r.y.v = out[1];
  s.r.z.v = out[2];
  s.reach.v = out[3];
  return s;
}

inline RelativeMotion relative_motion(const double* velocity, const Offset* i, const Offset* j) {
  Register row[8], out[8];
  for (int k = 0; k < 8; ++k)
    row[k] = _mm512_load_pd(row_at(velocity, 2 * std::size_t{j[k]})) * detail::subtract_then_add() +
             _mm512_load_pd(row_at(velocity, 2 * std::size_t{i[k]}));
  detail::transpose8(row, out);
  RelativeMotion m;
  m.v.x.v = out[0];
  m.v.y.v = out[1];
  m.v.z.v = out[2];
  m.size_difference.v = out[3];
  m.spin_sum.x.v = out[4];
  m.spin_sum.y.v = out[5];
  m.spin_sum.z.v = out[6];
  m.inverse_mass.v = out[7];
  return m;
}

// Half a row: v_i - v_j and r_i - r_j (first = 0), or omega_i - omega_j and 1/m_i - 1/m_j (first = 4).
inline RowDifference difference(const double* velocity, const Offset* i, const Offset* j, std::size_t first) {
  const auto half = [&](const Offset* o, int k) {
    return detail::halves(row_at(velocity, 2 * std::size_t{o[k]}) + first,
                          row_at(velocity, 2 * std::size_t{o[k + 4]}) + first);
  };
  Register row[4], out[4];
  for (int k = 0; k < 4; ++k) row[k] = half(i, k) - half(j, k);
  detail::transpose4(row, out);
  RowDifference d;
  d.xyz.x.v = out[0];
  d.xyz.y.v = out[1];
  d.xyz.z.v = out[2];
  d.fourth.v = out[3];
  return d;
}

// Adds force and torque to the rows, pair after pair, so that a grain may appear in several lanes.
inline void add_to_rows(double* force, const Offset* i, const Offset* j, const Vec3Of<Lanes>& f,
                        const Vec3Of<Lanes>& torque) {
  const Register zero{};
  const Register column[8] = {f.x.v, f.y.v, f.z.v, zero, torque.x.v, torque.y.v, torque.z.v, zero};
  Register row[8];
  detail::transpose8(column, row);
  for (int k = 0; k < 8; ++k) {
    double* a = row_at(force, 2 * std::size_t{i[k]});
    double* b = row_at(force, 2 * std::size_t{j[k]});
    _mm512_store_pd(a, _mm512_load_pd(a) + row[k]);
    _mm512_store_pd(b, row[k] * detail::subtract_then_add() + _mm512_load_pd(b));  // -f, +torque
  }
}

// The same with another torque on j.
inline void add_to_rows(double* force, const Offset* i, const Offset* j, const Vec3Of<Lanes>& f,
                        const Vec3Of<Lanes>& torque_i, const Vec3Of<Lanes>& torque_j) {
  const Register zero{};
  const Register on_i[8] = {f.x.v, f.y.v, f.z.v, zero, torque_i.x.v, torque_i.y.v, torque_i.z.v, zero};
  const Register on_j[8] = {f.x.v, f.y.v, f.z.v, zero, torque_j.x.v, torque_j.y.v, torque_j.z.v, zero};
  Register row_i[8], row_j[8];
  detail::transpose8(on_i, row_i);
  detail::transpose8(on_j, row_j);
  for (int k = 0; k < 8; ++k) {
    double* a = row_at(force, 2 * std::size_t{i[k]});
    double* b = row_at(force, 2 * std::size_t{j[k]});
    _mm512_store_pd(a, _mm512_load_pd(a) + row_i[k]);
    _mm512_store_pd(b, row_j[k] * detail::subtract_then_add() + _mm512_load_pd(b));
  }
}

#else

inline Separation separation(const double* position, const Offset* i, const Offset* j) {
  Separation s;
  for (int k = 0; k < Lanes::lanes; ++k) {
    const double *a = row_at(position, i[k]), *b = row_at(position, j[k]);
    s.r.x.set(k, a[0] - b[0]);
    s.r.y.set(k, a[1] - b[1]);
    s.r.z.set(k, a[2] - b[2]);
    s.reach.set(k, a[3] + b[3]);
  }
  return s;
}

inline RowDifference difference(const double* velocity, const Offset* i, const Offset* j, std::size_t first) {
  RowDifference d;
  for (int k = 0; k < Lanes::lanes; ++k) {
    const double *a = row_at(velocity, 2 * std::size_t{i[k]}) + first,
                 *b = row_at(velocity, 2 * std::size_t{j[k]}) + first;
    d.xyz.x.set(k, a[0] - b[0]);
    d.xyz.y.set(k, a[1] - b[1]);
    d.xyz.z.set(k, a[2] - b[2]);
    d.fourth.set(k, a[3] - b[3]);
  }
  return d;
}

inline RelativeMotion relative_motion(const double* velocity, const Offset* i, const Offset* j) {
  RelativeMotion m;
  m.v = difference(velocity, i, j, 0).xyz;
  for (int k = 0; k < Lanes::lanes; ++k) {
    const double *a = row_at(velocity, 2 * std::size_t{i[k]}), *b = row_at(velocity, 2 * std::size_t{j[k]});
    m.size_difference.set(k, a[3] - b[3]);
    m.spin_sum.x.set(k, a[4] + b[4]);
    m.spin_sum.y.set(k, a[5] + b[5]);
    m.spin_sum.z.set(k, a[6] + b[6]);
    m.inverse_mass.set(k, a[7] + b[7]);
  }
  return m;
}

inline void add_to_rows(double* force, const Offset* i, const Offset* j, const Vec3Of<Lanes>& f,
                        const Vec3Of<Lanes>& torque_i, const Vec3Of<Lanes>& torque_j) {
  const auto add = [](double* row, double sign, const Vec3Of<Lanes>& on, const Vec3Of<Lanes>& torque, int k) {
    row[0] += sign * on.x[k];
    row[1] += sign * on.y[k];
    row[2] += sign * on.z[k];
    row[4] += torque.x[k];
    row[5] += torque.y[k];
    row[6] += torque.z[k];
  };
  for (int k = 0; k < Lanes::lanes; ++k) {
    add(row_at(force, 2 * std::size_t{i[k]}), 1, f, torque_i, k);
    add(row_at(force, 2 * std::size_t{j[k]}), -1, f, torque_j, k);
  }
}

inline void add_to_rows(double* force, const Offset* i, const Offset* j, const Vec3Of<Lanes>& f,
                        const Vec3Of<Lanes>& torque) {
  add_to_rows(force, i, j, f, torque, torque);
}

#endif

}  // namespace bagnold::dem::fast

#pragma GCC diagnostic pop

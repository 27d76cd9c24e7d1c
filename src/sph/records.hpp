// What a pair loop reads of a neighbour lies together in memory, and eight neighbours are transposed in registers: far
// cheaper than one gather an array.
#pragma once
#include <cstdint>
#include <vector>

#include "core/memory.hpp"
#include "core/simd.hpp"
#include "sph/pairs.hpp"

namespace bagnold::sph {

// `Width` doubles (a multiple of eight) for every particle, image and the dummy.
template <int Width>
struct Records {
  static_assert(Width % Pack::lanes == 0);
  std::vector<Pack, LargePages<Pack>> data;
  double* at(std::int64_t i) { return reinterpret_cast<double*>(data.data()) + i * Width; }
  const double* at(std::int64_t i) const { return reinterpret_cast<const double*>(data.data()) + i * Width; }
  void resize(std::int64_t elements) {
    data.resize(static_cast<std::size_t>(elements * (Width / Pack::lanes)), Pack{});
  }
};

namespace detail {

// [a[0..4) | b[0..4)]
inline Register halves(const double* a, const double* b) {
#ifdef BAGNOLD_AVX512
  return _mm512_maskz_insertf64x4(0xff, _mm512_castpd256_pd512(_mm256_load_pd(a)), _mm256_load_pd(b), 1);
#else
  return Register{a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]};
#endif
}

}  // namespace detail

// out[f] = field f of the eight neighbours j, in the order 0 1 4 5 2 3 6 7. Four fields at a time: half as many shuffles as an 8 x 8 transposition, and
// the compiler drops those of fields nobody reads.
template <int Fields, int Width>
inline void gather(const Records<Width>& records, const std::int32_t* j, Pack (&out)[Fields]) {
  static_assert(Fields <= Width);
#pragma GCC unroll 8
  for (int first = 0; first < Fields; first += 4) {
    Register row[4];
    for (int k = 0; k < 4; ++k) row[k] = detail::halves(records.at(j[k]) + first, records.at(j[k + 4]) + first);
    const Register even01 = bagnold::detail::evens(row[0], row[1]), even23 = bagnold::detail::evens(row[2], row[3]),
                   odd01 = bagnold::detail::odds(row[0], row[1]), odd23 = bagnold::detail::odds(row[2], row[3]);
    out[first].v = bagnold::detail::even_pairs_of_each(even01, even23);
    if (first + 1 < Fields) out[first + 1].v = bagnold::detail::even_pairs_of_each(odd01, odd23);
    if (first + 2 < Fields) out[first + 2].v = bagnold::detail::odd_pairs_of_each(even01, even23);
    if (first + 3 < Fields) out[first + 3].v = bagnold::detail::odd_pairs_of_each(odd01, odd23);
  }
}

// Adds all packs of one particle, lane by lane, then the lanes in fixed order.
template <class F>
inline void for_each_pack(const Pairs& pairs, std::int64_t i, F&& f) {
  const auto begin = pairs.offset[static_cast<std::size_t>(i)], end = pairs.offset[static_cast<std::size_t>(i) + 1];
  for (auto q = begin; q < end; q += Pack::lanes) f(pairs.index.data() + q, static_cast<std::size_t>(q / Pack::lanes));
}

}  // namespace bagnold::sph

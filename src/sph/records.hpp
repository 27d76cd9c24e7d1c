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

// out[f] = field f of the eight neighbours j, in whatever order is cheapest, but always the same. Four fields at a time:
// half as many shuffles as an 8 x 8 transposition, and the compiler drops those of fields nobody reads.
template <int Fields, int Width>
[[gnu::always_inline]] inline void gather(const Records<Width>& records, const std::int32_t* j, Pack (&out)[Fields]) {
  static_assert(Fields <= Width);
#pragma GCC unroll 8
  for (int first = 0; first < Fields; first += 4) {
    Register row[4], column[4];
    for (int k = 0; k < 4; ++k)
      row[k] = simd::halves(simd::load_four(records.at(j[k]) + first), simd::load_four(records.at(j[k + 4]) + first));
    simd::transpose4_any_order(row, column);
    for (int c = 0; c < 4 && first + c < Fields; ++c) out[first + c].v = column[c];
  }
}

// Adds all packs of one particle, lane by lane, then the lanes in fixed order.
template <class F>
inline void for_each_pack(const Pairs& pairs, std::int64_t i, F&& f) {
  const auto begin = pairs.offset[static_cast<std::size_t>(i)], end = pairs.offset[static_cast<std::size_t>(i) + 1];
  for (auto q = begin; q < end; q += Pack::lanes) f(pairs.index.data() + q, static_cast<std::size_t>(q / Pack::lanes));
}

}  // namespace bagnold::sph

// What a pair loop reads of a neighbour lies together in memory, and eight neighbours are transposed in registers: far
// cheaper than one gather an array.
#pragma once
#include <cstdint>
#include <vector>

#include "core/octet.hpp"
#include "sph/pairs.hpp"

namespace bagnold::sph {

// `Width` doubles (a multiple of eight) for every particle, image and the dummy.
template <int Width>
struct Records {
  static_assert(Width % octet_size == 0);
  std::vector<Octet> data;
  double* at(std::int64_t i) { return reinterpret_cast<double*>(data.data()) + i * Width; }
  const double* at(std::int64_t i) const { return reinterpret_cast<const double*>(data.data()) + i * Width; }
  void resize(std::int64_t elements) {
    data.resize(static_cast<std::size_t>(elements * (Width / octet_size)), Octet{});
  }
};

// out[f] = field f of the eight neighbours j.
template <int Fields, int Width>
inline void gather(const Records<Width>& records, const std::int32_t* j, Octet (&out)[Fields]) {
  static_assert(Fields <= Width);
#pragma GCC unroll 4
  for (int first = 0; first < Fields; first += octet_size) {
    Octet r[octet_size];
    for (int k = 0; k < octet_size; ++k) r[k] = load_octet(records.at(j[k]) + first);
    transpose(r);
    for (int f = 0; f < octet_size; ++f)
      if (first + f < Fields) out[first + f] = r[f];
  }
}

// Adds all packs of one particle, lane by lane, then the lanes in fixed order.
template <class F>
inline void for_each_octet(const Pairs& pairs, std::int64_t i, F&& f) {
  const auto begin = pairs.offset[static_cast<std::size_t>(i)], end = pairs.offset[static_cast<std::size_t>(i) + 1];
  for (auto q = begin; q < end; q += octet_size) f(pairs.index.data() + q, static_cast<std::size_t>(q / octet_size));
}

}  // namespace bagnold::sph

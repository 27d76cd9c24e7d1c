// Counter-based random numbers (Philox 4x32-10, Salmon et al. 2011): a number depends only on (seed, stream, item,
// draw), never on who asked before, so results do not depend on threads or order.
#pragma once
#include <array>
#include <cstdint>

namespace bagnold::random {

// What a stream of numbers is for; keeps uses apart that share a seed.
enum class Stream : std::uint32_t { base = 1, fill = 2, sizes = 3, velocities = 4, perturbation = 5, test = 99 };

inline std::array<std::uint32_t, 4> philox(std::uint64_t seed, std::array<std::uint32_t, 4> counter) {
  std::uint32_t k0 = static_cast<std::uint32_t>(seed), k1 = static_cast<std::uint32_t>(seed >> 32);
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t{0xD2511F53} * counter[0], p1 = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {static_cast<std::uint32_t>(p1 >> 32) ^ counter[1] ^ k0, static_cast<std::uint32_t>(p1),
               static_cast<std::uint32_t>(p0 >> 32) ^ counter[3] ^ k1, static_cast<std::uint32_t>(p0)};
    k0 += 0x9E3779B9;
    k1 += 0xBB67AE85;
  }
  return counter;
}

// Two independent uniform numbers in [0, 1) with 53 bits each.
inline std::array<double, 2> uniform2(std::uint64_t seed, Stream stream, std::uint64_t item, std::uint32_t draw = 0) {
  const auto r = philox(seed, {static_cast<std::uint32_t>(item), static_cast<std::uint32_t>(item >> 32), draw,
                               static_cast<std::uint32_t>(stream)});
  const auto unit = [](std::uint32_t hi, std::uint32_t lo) {
    return static_cast<double>(((std::uint64_t{hi} << 32) | lo) >> 11) * 0x1.0p-53;
  };
  return {unit(r[0], r[1]), unit(r[2], r[3])};
}

inline double uniform(std::uint64_t seed, Stream stream, std::uint64_t item, std::uint32_t draw = 0) {
  return uniform2(seed, stream, item, draw)[0];
}

}  // namespace bagnold::random

// Who is near whom: every particle's neighbours (images included), padded to whole packs.
#pragma once
#include <cstdint>
#include <vector>

#include "core/memory.hpp"
#include "sph/images.hpp"

namespace bagnold::sph {

// Neighbours of particle i: index[offset[i] .. offset[i + 1]), a multiple of eight of them. j < n is a particle, n <= j <
// n + images an image, and the last number is a dummy that interacts with nobody and fills the packs.
inline constexpr std::int64_t pair_block = 32;  // particles a sweep takes at a time

struct Pairs {
  std::vector<std::int64_t> offset;
  std::vector<std::int32_t, LargePages<std::int32_t>> index;
  Images images;
  std::int64_t elements(std::int64_t n) const { return n + images.size() + 1; }  // particles, images, the dummy
};

// True when some particle has moved, or will have within the time `lead`, so far that a pair closer than 2h may be missing.
bool outdated(const Pairs& pairs, const Particles& particles, int dim, double lead);

// Wraps periodic positions, reorders all particles along the cells, remembers x_built, lists the pairs. `travel` is how
// far a particle may go before the next time; the skin is twice that, within bounds.
void rebuild(Pairs& pairs, Particles& particles, const Model& model, double travel);
// The list that belongs to x_built, for a state read from a checkpoint.
void relist(Pairs& pairs, const Particles& particles, const Model& model);

}  // namespace bagnold::sph

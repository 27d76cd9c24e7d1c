// Several time steps in one pass over memory. Slabs lie in a ring; section a is slab a and its pairs with slab a + 1.
//
// Step t of slab a (move it) needs the forces of step t - 1 on it, from sections a - 1 and a; step t of section a (its
// forces) needs slabs a and a + 1 moved by step t. So within a block of slabs [b, e) steps can run ahead of the rest
// of the ring as a triangle that loses a slab at each end per step,
//     rise:  step t moves slabs  b + t .. e - 1 - t   and acts in sections  b + t .. e - 2 - t,
// and what is left open around the border e of two blocks is the triangle upside down,
//     fall:  step t moves slabs  e - t .. e - 1 + t   and acts in sections  e - 1 - t .. e - 1 + t.
// All rises are independent, then all falls are, if every block has at least 2 `levels` slabs: blocks are the units of
// parallel work. Inside a rise step t follows step t - 1 at a distance of one slab, so that a slab is in the cache from
// its first step to its last.
//
// The order in which a slab receives the forces of its two sections depends on its place and on t alone. `levels`
// divides time into epochs, t = step mod levels, and a pass may cover any part [from, to) of an epoch: neither threads
// nor where a pass ends change a result.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/parallel.hpp"

namespace bagnold::dem::fast {

struct Ring {
  int slabs = 1, levels = 1;
  std::vector<int> border{0, 1};  // block k has the slabs from border[k] to border[k + 1]
  int blocks() const { return static_cast<int>(border.size()) - 1; }
  int wrap(int a) const { return a < 0 ? a + slabs : a >= slabs ? a - slabs : a; }
};

// At most `levels` steps per pass. Blocks, an even number of them, have about 16 slabs and about as many grains each;
// grains[a]: those in slab a.
inline Ring make_ring(const std::vector<std::size_t>& grains, int levels) {
  const auto slabs = static_cast<int>(grains.size());
  Ring ring{slabs, levels, {0}};
  while (ring.levels > 1 && slabs < 2 * ring.levels) --ring.levels;
  const int fewest = 2 * ring.levels, blocks = slabs < 2 * fewest || slabs < 8 ? 1 : slabs < 64 ? 2 : slabs / 32 * 2;
  const std::size_t all = std::reduce(grains.begin(), grains.end());
  std::size_t before = 0;  // grains in the slabs before `a`
  for (int k = 1, a = 0; k < blocks; ++k) {
    const int first = ring.border.back() + fewest, last = slabs - (blocks - k) * fewest;
    while (a < first || (a < last && before * static_cast<std::size_t>(blocks) < all * static_cast<std::size_t>(k)))
      before += grains[static_cast<std::size_t>(a++)];
    ring.border.push_back(a);
  }
  ring.border.push_back(slabs);
  return ring;
}

// move(slab, t) and act(section, t) for every slab, section and t in [from, to), on all threads.
template <class Move, class Act>
void sweep(const Ring& ring, int from, int to, bool threads, Move&& move, Act&& act) {
  const auto rise = [&](std::int64_t k) {
    const int b = ring.border[static_cast<std::size_t>(k)], e = ring.border[static_cast<std::size_t>(k) + 1];
    for (int front = b + from; front <= e - 1 - from; ++front)
      for (int t = from; t < to; ++t) {
        const int a = front - (t - from);
        if (a < b + t || a > e - 1 - t) continue;
        move(a, t);
        if (a > b + t) act(a - 1, t);
      }
  };
  const auto fall = [&](std::int64_t k) {
    const int e = ring.border[static_cast<std::size_t>(k) + 1];
    for (int t = from; t < to; ++t) {
      for (int a = e - t; a <= e - 1 + t; ++a) move(ring.wrap(a), t);
      for (int a = e - 1 - t; a <= e - 1 + t; ++a) act(ring.wrap(a), t);
    }
  };
  parallel_for(ring.blocks(), rise, threads);
  parallel_for(ring.blocks(), fall, threads);
}

}  // namespace bagnold::dem::fast

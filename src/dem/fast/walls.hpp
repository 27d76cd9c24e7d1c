// Grains at planes. A wall is a row at rest, at the origin and without size in every slab, so that a grain and a wall are
// fetched as two grains are; what is particular to a plane is here.
//
// Grains near a wall are listed when the outer list is made, by their start: those that reach it, or would if they came
// closer by half the skin. The list holds as long as the outer one, because the frame in which excursions are measured
// does not move along the normal of any wall. A grain stays in its place of the list, and its spring with it.
#pragma once
#include <span>

#include "dem/fast/kernel.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

// Eight places of a list, all at one wall, of which the first `count` are taken.
struct WallBatch {
  std::uint32_t wall, count;
};

// The grains of a slab near walls: by wall, then in the order of their rows.
struct WallList {
  std::vector<WallBatch> batches;
  Aligned<Offset> i, j;         // rows of grain and wall; places not taken repeat the last that is
  Aligned<std::uint32_t> kind;  // where the constants of the pair begin; only if they depend on the species
  Aligned<double> history;      // as of pairs
};

// A grain at a wall and what their contact remembers.
struct WallTouch {
  std::size_t grain, wall;
  Vec3 spring, roll;
};

// Forces of the grains of a slab at walls, through the same law as pairs (wall_motion and wall_size in
// dem/contact_laws.hpp).
template <class Tables, bool OneKind>
struct WallKernel {
  static constexpr bool rolls = std::remove_pointer_t<decltype(Tables::rolling)>::active;
  static constexpr std::size_t history_numbers = rolls ? 6 : 3;
  using Motion = laws::PairMotion<Lanes>;
  using Size = laws::PairSize<Lanes>;
  using History = laws::PairHistory<Lanes>;

  // As the law sees it, and whether grain and wall touch; places that are not taken never do.
  struct Encounter {
    Motion motion;
    Size size;
    Lanes overlap;
    Mask touching;
  };
  static Encounter encounter(const Rows& rows, const Offset* i, const Offset* j, const Wall& wall,
                             std::uint32_t taken) {
    const Separation s = separation(rows.position.data(), i, j);
    const RelativeMotion m = relative_motion(rows.velocity.data(), i, j);
    const Vec3Of<Lanes> n{wall.normal.x, wall.normal.y, wall.normal.z}, point{wall.point.x, wall.point.y, wall.point.z};
    const Lanes height = dot(s.r - point, n), zero = 0.0, radius = s.reach;
    Size size{};
    size.reduced_radius = radius;
    size.inverse_reduced_mass = size.inverse_mass_i = m.inverse_mass;
    size.inverse_radius_i = Lanes(1) / radius;
    size.inverse_radius_j = size.inverse_mass_j = zero;
    return {{height * n, m.v, m.spin_sum, m.spin_sum, radius, radius, zero},
            size,
            radius - height,
            (height < radius) & lanes_between(0, static_cast<int>(taken))};
  }

  static auto law_of(const Tables& tables, const KernelInput& input, const WallList& list, std::size_t place) {
    return pack_laws(tables, [&](std::size_t c) {
      return OneKind ? Lanes(input.constants[c]) : gather(input.constants + c, &list.kind[place]);
    });
  }

  static History history_at(const WallList& list, std::size_t place) {
    const Lanes zero = 0.0;
    const double* memory = list.history.data() + place * history_numbers;
    History history{load_vector(memory), {zero, zero, zero}};
    if constexpr (rolls) history.roll = load_vector(memory + 24);
    return history;
  }

  // As Kernel::act; packs are appended.
  template <class Ledger>
  static double act(Rows& rows, WallList& list, std::span<const Wall> walls, const Tables& tables,
                    const KernelInput& input, Ledger& ledger, ContactPack* seen, std::size_t& packs) {
    const Lanes zero = 0.0;
    const Vec3Of<Lanes> nothing{zero, zero, zero};
    Lanes excess = -1.0;
    for (std::size_t b = 0, place = 0; b < list.batches.size(); ++b, place += batch) {
      const Offset *i = &list.i[place], *j = &list.j[place];
      const auto [wall, taken] = list.batches[b];
      const auto [motion, size, overlap, touching] = encounter(rows, i, j, walls[wall], taken);
      const auto geometry = laws::pair_geometry(motion);
      const History before = history_at(list, place);
      History history = before;
      const auto force =
          laws::interact<true>(law_of(tables, input, list, place), geometry, size, Lanes(input.dt), history);
      double* memory = list.history.data() + place * history_numbers;
      store_vector(select(touching, history.spring, nothing), memory);
      if constexpr (rolls) store_vector(select(touching, history.roll, nothing), memory + 24);
      add_to_rows(rows.force.data(), i, j, select(touching, force.force, nothing),
                  select(touching, force.torque_i, nothing));
      excess = max(excess, select(touching, overlap - Lanes(input.overlap_ratio) * motion.reach, Lanes(-1.0)));
      alignas(64) double noted[(Ledger::noted + 1) * batch];
      ledger.note(geometry, force, touching, before, place, noted);
      ledger.deposit(i, j, noted);
      if (seen == nullptr || !any(touching)) continue;
      ContactPack& pack = seen[packs++];
      store_vector(motion.r, pack.branch[0].data());
      store_vector(geometry.n, pack.normal[0].data());
      store_vector(force.force, pack.force[0].data());
      geometry.overlap.store(pack.overlap.data());
      pack.touching = to_integer(touching);
      for (std::size_t k = 0; k < batch; ++k) {
        pack.i[k] = static_cast<std::uint32_t>(row_of(i[k]));
        pack.j[k] = static_cast<std::uint32_t>(row_of(j[k]));
      }
    }
    return largest(excess);
  }
};

}  // namespace bagnold::dem::fast

#pragma GCC diagnostic pop

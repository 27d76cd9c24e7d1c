// Forces of eight pairs at a time, through the pair law of laws/contact/pair.hpp and nothing else: here rows become
// packs, the law acts on every pair of the list as if it touched, and masks drop what pairs apart would do.
#pragma once
#include <cstring>
#include <type_traits>

#include "dem/contact_laws.hpp"
#include "dem/fast/lists.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

inline constexpr std::size_t batch = Lanes::lanes;

// Packs the constants of a law from an array of its numbers, from `numbers` on: a law is a bundle of numbers, an empty
// type if it has none. source(c): number c of the pairs' laws in every lane.
template <template <class> class Law, class Source>
Law<Lanes> pack_law(const Law<double>*, std::size_t& first, Source&& source) {
  Law<Lanes> packed{};
  if constexpr (!std::is_empty_v<Law<double>>) {
    constexpr std::size_t numbers = sizeof(Law<double>) / sizeof(double);
    static_assert(sizeof(packed) == numbers * sizeof(Lanes));
    Lanes values[numbers];
    for (std::size_t c = 0; c < numbers; ++c) values[c] = source(first + c);
    std::memcpy(&packed, values, sizeof packed);
    first += numbers;
  }
  return packed;
}
template <class Tables, class Source>
auto pack_laws(const Tables& tables, Source&& source) {
  std::size_t first = 0;
  const auto normal = pack_law(tables.normal, first, source);
  const auto tangential = pack_law(tables.tangential, first, source);
  const auto rolling = pack_law(tables.rolling, first, source);
  return laws::PairLaw<std::decay_t<decltype(normal)>, std::decay_t<decltype(tangential)>,
                       std::decay_t<decltype(rolling)>>{normal, tangential, rolling};
}

// All constants of every pair of species, one pair after the other; returns how many there are of each.
template <class Tables>
std::size_t flatten_tables(const Tables& tables, std::vector<double>& out) {
  out.clear();
  for (std::int32_t k = 0; k < tables.species * tables.species; ++k) {
    const auto append = [&](const auto& law) {
      if constexpr (!std::is_empty_v<std::decay_t<decltype(law)>>) {
        const std::size_t n = out.size();
        out.resize(n + sizeof law / sizeof(double));
        std::memcpy(&out[n], &law, sizeof law);
      }
    };
    append(tables.normal[k]);
    append(tables.tangential[k]);
    append(tables.rolling[k]);
  }
  return out.size() / static_cast<std::size_t>(tables.species * tables.species);
}

// The pairs of a section as the kernel walks through them, padded to whole batches.
struct Batches {
  const Offset *i, *j;
  const std::uint32_t* kind;  // where the constants of the pair begin; read only when they depend on the species
  double* history;            // per group of eight pairs: each number of the history in eight lanes
  std::size_t count;
};

// What it needs to know beside the pairs.
struct KernelInput {
  const double* constants;  // flatten_tables
  Images images;
  double dt;
  double overlap_ratio;  // overlap/radius that counts as too large
};

// EqualRadii: all grains have the same. OneKind: so do the constants of all species.
template <class Tables, bool EqualRadii, bool OneKind>
struct Kernel {
  static constexpr bool rolls = std::remove_pointer_t<decltype(Tables::rolling)>::active;
  static constexpr bool symmetric = EqualRadii && !rolls;  // the torques on i and j are the same
  static constexpr std::size_t history_numbers = rolls ? 6 : 3;
  using Motion = laws::PairMotion<Lanes, EqualRadii>;
  using Size = laws::PairSize<Lanes>;
  using History = laws::PairHistory<Lanes>;

  static Size sizes(const Motion& m, const Lanes& inverse_mass, const Lanes& mass_difference) {
    Size size{};
    size.inverse_reduced_mass = inverse_mass;
    if constexpr (EqualRadii)
      size.reduced_radius = Lanes(0.25) * m.reach;
    else
      size.reduced_radius = (m.reach * m.reach - m.size_difference * m.size_difference) / (Lanes(4) * m.reach);
    if constexpr (rolls) {
      size.inverse_radius_i = Lanes(2) / (m.reach + m.size_difference);
      size.inverse_radius_j = Lanes(2) / (m.reach - m.size_difference);
      size.inverse_mass_i = Lanes(0.5) * (inverse_mass + mass_difference);
      size.inverse_mass_j = Lanes(0.5) * (inverse_mass - mass_difference);
    }
    return size;
  }

  static Vec3Of<Lanes> load(const double* memory) {
    return {Lanes::load(memory), Lanes::load(memory + 8), Lanes::load(memory + 16)};
  }
  static void store(const Vec3Of<Lanes>& a, double* memory) {
    a.x.store(memory);
    a.y.store(memory + 8);
    a.z.store(memory + 16);
  }

  // Adds what the pairs do to the force rows, moves their history on by dt. Returns by how much the largest overlap
  // exceeds the permitted one.
  [[gnu::flatten]] static double act(Rows& rows, const Batches& pairs, const Tables& tables, const KernelInput& input) {
    const double *position = rows.position.data(), *velocity = rows.velocity.data();
    double* force_rows = rows.force.data();
    const Lanes zero = 0.0, dt = input.dt;
    const Vec3Of<Lanes> nothing{zero, zero, zero};
    auto law = pack_laws(tables, [&](std::size_t c) { return Lanes(input.constants[c]); });
    Lanes excess = -1.0;

    for (std::size_t p = 0; p < pairs.count; p += batch) {
      const Offset *i = pairs.i + p, *j = pairs.j + p;
      double* memory = pairs.history + p * history_numbers;
      const Separation apart = separation(position, i, j);
      const RelativeMotion moving = relative_motion(velocity, i, j);
      Motion m{fold(input.images, apart.r), moving.v, moving.spin_sum, nothing, apart.reach,
               moving.size_difference,      1.0};
      Lanes mass_difference = zero;
      if constexpr (!symmetric) {
        const RowDifference d = difference(velocity, i, j, 4);
        m.spin_difference = d.xyz;
        mass_difference = d.fourth;
      }
      if constexpr (!OneKind)
        law = pack_laws(tables, [&](std::size_t c) { return gather(input.constants + c, pairs.kind + p); });

      const auto geometry = laws::pair_geometry(m);
      History history{load(memory), nothing};
      if constexpr (rolls) history.roll = load(memory + 24);
      const auto force =
          laws::interact<true>(law, geometry, sizes(m, moving.inverse_mass, mass_difference), dt, history);
      const auto touching = geometry.overlap > zero;
      store(select(touching, history.spring, nothing), memory);
      if constexpr (rolls) store(select(touching, history.roll, nothing), memory + 24);

      const Lanes smaller = EqualRadii ? m.reach : m.reach - abs(m.size_difference);  // twice the smaller radius
      excess = max(excess, geometry.overlap - Lanes(0.5 * input.overlap_ratio) * smaller);
      const auto on_i = select(touching, force.force, nothing), torque_i = select(touching, force.torque_i, nothing);
      if constexpr (symmetric)
        add_to_rows(force_rows, i, j, on_i, torque_i);
      else
        add_to_rows(force_rows, i, j, on_i, torque_i, select(touching, force.torque_j, nothing));
    }
    double largest = excess[0];
    for (int k = 1; k < Lanes::lanes; ++k) largest = excess[k] > largest ? excess[k] : largest;
    return largest;
  }
};

}  // namespace bagnold::dem::fast

#pragma GCC diagnostic pop

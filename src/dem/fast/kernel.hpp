// Forces of eight pairs at a time, through the pair law of laws/contact/pair.hpp and nothing else: here rows become
// packs, the law acts on every pair of the list as if it touched, and masks drop what pairs apart would do.
#pragma once
#include <algorithm>
#include <cstring>
#include <type_traits>

#include "dem/contact_laws.hpp"
#include "dem/fast/contact_pack.hpp"
#include "dem/fast/lists.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

inline constexpr std::size_t batch = Lanes::lanes;

// Packs the constants of a law from an array of its numbers, from `numbers` on: a law is a bundle of numbers, an empty
// type if it has none. source(c): number c of the pairs' laws in every lane.
template <template <class> class Law, class Source>
Law<Lanes> pack_law(const Law<double>*, std::size_t& first, Source&& source) {
  if constexpr (std::is_empty_v<Law<double>>) {
    return {};
  } else {
    constexpr std::size_t numbers = sizeof(Law<double>) / sizeof(double);
    const std::size_t begin = first;
    first += numbers;
    return [&]<std::size_t... C>(std::index_sequence<C...>) { return Law<Lanes>{source(begin + C)...}; }
    (std::make_index_sequence<numbers>());
  }
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

// Whether a normal law depends on the masses and radii of a pair, which the kernel otherwise need not fetch.
template <class Normal>
inline constexpr bool reads_size = true;
template <>
inline constexpr bool reads_size<laws::LinearNormal<double>> = false;

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

inline Vec3Of<Lanes> load_vector(const double* memory) {
  return {Lanes::load(memory), Lanes::load(memory + 8), Lanes::load(memory + 16)};
}
inline void store_vector(const Vec3Of<Lanes>& a, double* memory) {
  a.x.store(memory);
  a.y.store(memory + 8);
  a.z.store(memory + 16);
}

// What a kernel says of every batch to who keeps account of energy (PairLedger in dem/fast/ledger.hpp); nobody does here.
struct NoLedger {
  static constexpr std::size_t noted = 0;  // packs between note() and deposit()
  void note(auto&&...) const {}
  void deposit(auto&&...) const {}
};

// EqualRadii: all grains have the same. OneKind: so do the constants of all species.
template <class Tables, bool EqualRadii, bool OneKind>
struct Kernel {
  static constexpr bool one_kind = OneKind;
  static constexpr bool rolls = std::remove_pointer_t<decltype(Tables::rolling)>::active;
  static constexpr bool sized = reads_size<std::remove_cvref_t<decltype(*Tables::normal)>> || !EqualRadii;
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

  static auto law_of(const Tables& tables, const KernelInput& input, const Batches& pairs, std::size_t place) {
    return pack_laws(tables, [&](std::size_t c) {
      return OneKind ? Lanes(input.constants[c]) : gather(input.constants + c, pairs.kind + place);
    });
  }

  // What the law wants to know of a batch: r, v_ij, omega_i + omega_j, r_i + r_j; if it matters 1/m_i + 1/m_j and
  // r_i - r_j; unless the torques are the same omega_i - omega_j and 1/m_i - 1/m_j.
  static constexpr std::size_t collected = symmetric ? (sized ? 12 : 10) : 16, acted = symmetric ? 6 : 9;

  static void collect(const double* position, const double* velocity, const Offset* i, const Offset* j,
                      const Images& images, double* to) {
    const Separation apart = separation(position, i, j);
    const RelativeMotion moving = relative_motion(velocity, i, j);
    store_vector(fold(images, apart.r), to);
    store_vector(moving.v, to + 24);
    store_vector(moving.spin_sum, to + 48);
    apart.reach.store(to + 72);
    if constexpr (collected > 10) {
      moving.inverse_mass.store(to + 80);
      moving.size_difference.store(to + 88);
    }
    if constexpr (collected > 12) {
      const RowDifference d = difference(velocity, i, j, 4);
      store_vector(d.xyz, to + 96);
      d.fourth.store(to + 120);
    }
  }

  // What collect() has put there, as the law sees it.
  struct Encounter {
    Motion motion;
    Size size;
  };
  static Encounter encounter(const double* from) {
    const Lanes zero = 0.0;
    const Vec3Of<Lanes> nothing{zero, zero, zero};
    Motion m{
        load_vector(from), load_vector(from + 24), load_vector(from + 48), nothing, Lanes::load(from + 72), zero, 1.0};
    Lanes inverse_mass = zero, mass_difference = zero;
    if constexpr (collected > 10) {
      inverse_mass = Lanes::load(from + 80);
      m.size_difference = Lanes::load(from + 88);
    }
    if constexpr (collected > 12) {
      m.spin_difference = load_vector(from + 96);
      mass_difference = Lanes::load(from + 120);
    }
    return {m, sizes(m, inverse_mass, mass_difference)};
  }

  // Force and torques of a batch, 0 where the pair does not touch; its history moves on by dt. Returns the overlaps in
  // excess of the permitted one. `record`: also what an observer wants to know but for the rows.
  template <bool record, class Law, class Ledger>
  static Lanes interact(const Law& law, const double* from, const Lanes& dt, const Lanes& overlap_ratio, double* memory,
                        double* to, ContactPack* seen, Ledger& ledger, std::size_t place) {
    const Lanes zero = 0.0;
    const Vec3Of<Lanes> nothing{zero, zero, zero};
    const auto [m, size] = encounter(from);
    const auto geometry = laws::pair_geometry(m);
    History history{load_vector(memory), nothing};
    if constexpr (rolls) history.roll = load_vector(memory + 24);
    const History before = history;
    const auto force = laws::interact<true>(law, geometry, size, dt, history);
    const auto touching = geometry.overlap > zero;
    store_vector(select(touching, history.spring, nothing), memory);
    if constexpr (rolls) store_vector(select(touching, history.roll, nothing), memory + 24);
    store_vector(select(touching, force.force, nothing), to);
    store_vector(select(touching, force.torque_i, nothing), to + 24);
    if constexpr (!symmetric) store_vector(select(touching, force.torque_j, nothing), to + 48);
    ledger.note(geometry, force, touching, before, place, to + acted * batch);
    if constexpr (record) {
      store_vector(m.r, seen->branch[0].data());
      store_vector(geometry.n, seen->normal[0].data());
      store_vector(force.force, seen->force[0].data());
      geometry.overlap.store(seen->overlap.data());
      seen->touching = to_integer(touching);
    }
    const Lanes smaller = EqualRadii ? m.reach : m.reach - abs(m.size_difference);  // twice the smaller radius
    return geometry.overlap - overlap_ratio * (Lanes(0.5) * smaller);
  }

  static void deposit(double* force, const Offset* i, const Offset* j, const double* from) {
    if constexpr (symmetric)
      add_to_rows(force, i, j, load_vector(from), load_vector(from + 24));
    else
      add_to_rows(force, i, j, load_vector(from), load_vector(from + 24), load_vector(from + 48));
  }

  // Adds what the pairs do to the force rows, moves their history on by dt. Returns by how much the largest overlap
  // exceeds the permitted one. With `seen`, which has room for a pack per batch, also the contacts; `packs` are written.
  template <class Ledger>
  static double act(Rows& rows, const Batches& pairs, const Tables& tables, const KernelInput& input, Ledger& ledger,
                    ContactPack* seen, std::size_t& packs) {
    packs = 0;
    if (pairs.count == 0) return -1;
    return seen == nullptr ? act<false>(rows, pairs, tables, input, ledger, seen, packs)
                           : act<true>(rows, pairs, tables, input, ledger, seen, packs);
  }
  static double act(Rows& rows, const Batches& pairs, const Tables& tables, const KernelInput& input) {
    NoLedger none;
    std::size_t packs = 0;
    return act(rows, pairs, tables, input, none, nullptr, packs);
  }

 private:
  template <bool record, class Ledger>
  static double act(Rows& rows, const Batches& pairs, const Tables& tables, const KernelInput& input, Ledger& ledger,
                    ContactPack* seen, std::size_t& packs) {
    return act<record>(rows.position.data(), rows.velocity.data(), rows.force.data(), pairs.i, pairs.j, pairs.kind,
                       pairs.history, pairs.count, tables, input, ledger, seen, packs);
  }

  // The law on a batch is one long chain of operations, each waiting for the last, while fetching rows and adding to rows
  // wait for memory and shuffles. So every turn takes three batches: it adds up the last, acts on the present and
  // collects the next, none of which needs the others, and the compiler mixes them (module.cmake asks it to). It may
  // because nothing here overlaps in memory: __restrict.
  template <bool record, class Ledger>
  [[gnu::flatten, gnu::noinline]] static double act(const double* __restrict position,
                                                    const double* __restrict velocity, double* __restrict force,
                                                    const Offset* __restrict i, const Offset* __restrict j,
                                                    const std::uint32_t* __restrict kind, double* __restrict history,
                                                    std::size_t count, const Tables& tables, const KernelInput input,
                                                    Ledger& account, ContactPack* __restrict seen, std::size_t& packs) {
    Ledger ledger = account;  // in registers
    const Lanes dt = input.dt, ratio = input.overlap_ratio;
    auto law = pack_laws(tables, [&](std::size_t c) { return Lanes(input.constants[c]); });
    Lanes excess = -1.0;
    alignas(64) double in[2 * collected * batch], out[(acted + Ledger::noted) * batch] = {};
    std::size_t now = 0, before = 0;
    const std::size_t last = (count - 1) / batch * batch;
    collect(position, velocity, i, j, input.images, in);
    for (std::size_t p = 0; p <= last; p += batch) {
      if constexpr (!OneKind)
        law = pack_laws(tables, [&](std::size_t c) { return gather(input.constants + c, kind + p); });
      const double* from = in + now;
      now = collected * batch - now;
      const std::size_t next = std::min(p + batch, last);
      deposit(force, i + before, j + before, out);
      ledger.deposit(i + before, j + before, out + acted * batch);
      excess = max(excess, interact<record>(law, from, dt, ratio, history + p * history_numbers, out, seen, ledger, p));
      if constexpr (record) {
        for (std::size_t k = 0; k < batch; ++k) {
          seen->i[k] = static_cast<std::uint32_t>(row_of(i[p + k]));
          seen->j[k] = static_cast<std::uint32_t>(row_of(j[p + k]));
        }
        const std::size_t kept = seen->touching != 0 ? 1 : 0;
        seen += kept;
        packs += kept;
      }
      collect(position, velocity, i + next, j + next, input.images, in + now);
      before = p;
    }
    deposit(force, i + last, j + last, out);
    ledger.deposit(i + last, j + last, out + acted * batch);
    account = ledger;
    double largest = excess[0];
    for (int k = 1; k < Lanes::lanes; ++k) largest = excess[k] > largest ? excess[k] : largest;
    return largest;
  }
};

}  // namespace bagnold::dem::fast

#pragma GCC diagnostic pop

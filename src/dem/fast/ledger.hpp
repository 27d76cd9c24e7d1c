// The energy ledger of the fast engine (DemState::keep_ledger).
//
// A dashpot takes -f.v from two grains that move at v. Summed over the contacts of a grain first, that is minus the sum of
// the dashpots' forces and torques on every grain times its velocities; and these are known at the time of the positions as
// soon as all forces are. So the kernel, beside forces, adds the forces and torques of dashpots to rows of their own, and
// after a step every grain multiplies them with its velocities. What sliders take comes along in the same rows, half for
// each of the two. All sums are in the order of rows and lists, which hold whatever the threads and the interruptions.
//
//   normal       { normal dashpots' force,  0,       torque of tangential dashpots, 0 }
//   tangential   { tangential dashpots' force,  0,   sliding, rolling sliders, 0, 0 }
//   rolling      { torque of rolling dashpots,  0,   0, 0, 0, 0 }                        only where grains resist rolling
#pragma once
#include <span>

#include "dem/fast/kernel.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

struct Engine;
struct Slab;

// Of the contacts of a slab in a step: power of the dashpots, and energies.
struct Losses {
  Dissipation power;
  double sliding = 0, roll_sliding = 0, opened = 0;
};

struct LedgerRows {
  Aligned<double> normal, tangential, rolling;  // 0 between passes
  std::vector<Losses> losses;                   // by step of a pass, then slab
};

// Contacts that open: what they remember is noted before it is forgotten.
struct Opened {
  std::uint32_t place, lanes;  // the first of eight pairs of a list; which of them
};
struct OpenedContacts {
  Aligned<double> history;  // of eight pairs each
  std::vector<Opened> where;
  void make_room(std::size_t batches, std::size_t numbers) {
    if (where.size() < batches) where.resize(batches + batches / 4 + 8);
    if (history.size() < where.size() * numbers * batch) history.resize(where.size() * numbers * batch);
  }
};

// What the kernel says of its contacts goes to these rows. `symmetric`: the torques on i and j are the same.
template <bool symmetric, bool rolls>
struct PairLedger {
  double *normal, *tangential, *rolling;  // rows
  double* history;                        // of opened contacts
  Opened* where;
  std::size_t count;

  static constexpr std::size_t second_torque = 11, rolling_torque = second_torque + (symmetric ? 0 : 3),
                               noted = rolling_torque + (rolls ? 3 : 0), history_packs = rolls ? 6 : 3;

  template <class Touching>
  void note(const laws::PairGeometry<Lanes>& g, const laws::PairForce<Lanes>& force, const Touching& touching,
            const laws::PairHistory<Lanes>& before, std::size_t place, double* to) {
    const Lanes zero = 0.0;
    const Vec3Of<Lanes> nothing{zero, zero, zero}, push = select(touching, force.tangential_damping, nothing);
    store_vector(select(touching, force.normal_damping, zero) * g.n, to);
    store_vector(push, to + 3 * batch);
    store_vector(cross(push, g.arm_i), to + 6 * batch);
    select(touching, Lanes(0.5) * force.slide_loss, zero).store(to + 9 * batch);
    select(touching, Lanes(0.5) * force.roll_loss, zero).store(to + 10 * batch);
    if constexpr (!symmetric) store_vector(cross(push, g.arm_j), to + second_torque * batch);
    if constexpr (rolls) store_vector(select(touching, force.roll_damping, nothing), to + rolling_torque * batch);

    double* kept = history + count * history_packs * batch;
    store_vector(before.spring, kept);
    Lanes remembers = dot(before.spring, before.spring);
    if constexpr (rolls) {
      store_vector(before.roll, kept + 3 * batch);
      remembers += dot(before.roll, before.roll);
    }
    const std::uint32_t lanes = to_integer((!touching) & (remembers > zero));
    where[count] = {static_cast<std::uint32_t>(place), lanes};
    count += lanes != 0 ? 1 : 0;
  }

  void deposit(const Offset* i, const Offset* j, const double* from) const {
    const Lanes zero = 0.0;
    const Vec3Of<Lanes> push = load_vector(from), torque = load_vector(from + 6 * batch);
    if constexpr (symmetric)
      add_to_rows(normal, i, j, push, torque);
    else
      add_to_rows(normal, i, j, push, torque, load_vector(from + second_torque * batch));
    add_to_rows(tangential, i, j, load_vector(from + 3 * batch),
                {Lanes::load(from + 9 * batch), Lanes::load(from + 10 * batch), zero});
    if constexpr (rolls) add_to_rows(rolling, i, j, load_vector(from + rolling_torque * batch), {zero, zero, zero});
  }
};

// Energy of the springs of contacts that opened. see(place): the encounter and the law of the eight pairs there.
template <bool symmetric, bool rolls, class See>
double energy_of(const PairLedger<symmetric, rolls>& opened, double dt, See&& see) {
  const Lanes zero = 0.0;
  double sum = 0;
  for (std::size_t n = 0; n < opened.count; ++n) {
    const auto [encounter, law] = see(opened.where[n].place);
    const double* kept = opened.history + n * opened.history_packs * batch;
    laws::PairHistory<Lanes> history{load_vector(kept), {zero, zero, zero}};
    if constexpr (rolls) history.roll = load_vector(kept + 3 * batch);
    const Lanes energy =
        laws::energy_left(law, laws::pair_geometry(encounter.motion), encounter.size, history, Lanes(dt));
    for (std::uint32_t left = opened.where[n].lanes; left != 0; left &= left - 1) sum += energy[__builtin_ctz(left)];
  }
  return sum;
}

// Empty rows for the grains of the engine.
void open_ledger(Engine& engine);

// Power of the dashpots on the grains of a slab and what sliders took, all forces of the step being there; `half_step`:
// by how much velocities lag behind positions. The rows are empty again. Nothing else changes.
void take_losses(Engine& engine, const Slab& slab, double half_step, Losses& out);

// Enters the losses of `count` steps, the first of them `step`, in the ledger of the state.
void enter_losses(const Engine& engine, std::int64_t step, int count, DemState& state);

}  // namespace bagnold::dem::fast

#pragma GCC diagnostic pop

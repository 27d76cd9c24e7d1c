// The fast engine: the same trajectory as the plain one (dem/algorithm.cpp) to round-off, from a sorted copy of the
// grains, three levels of lists (lists.hpp), forces of eight pairs at a time (kernel.hpp) and several steps per pass
// over memory (sweep.hpp). It lives as long as the state is advanced by it and nobody else changes the state; all it
// holds follows from the state, so that a resumed run makes the same bits.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "dem/algorithm.hpp"
#include "dem/contact_model.hpp"
#include "dem/fast/kernel.hpp"
#include "dem/fast/ledger.hpp"
#include "dem/fast/lists.hpp"
#include "dem/fast/sweep.hpp"
#include "dem/fast/walls.hpp"
#include "dem/observe.hpp"
#include "dem/state.hpp"

namespace bagnold::dem::fast {

// How many steps each list is made for; how many a pass takes.
inline constexpr int mid_steps = 48, inner_steps = 4, steps_per_pass = 4;

struct Slab {
  // Rows: flowing, then fixed grains, then two that never touch, then one for each wall.
  std::size_t begin = 0, moving_end = 0, end = 0;
  double acceleration = 0;  // largest at the last step
  // Excursion from the start of the outer list is at most excursion + drift.distance for `steps_left` more steps.
  double excursion = 0;
  Drift drift;
  std::int64_t steps_left = 0;
};

struct Section {
  Aligned<Offset> outer_i, outer_j;  // all pairs within the skin, readable to the next multiple of eight
  std::size_t outer_count = 0;
  Selection mid, inner;
  Aligned<std::uint32_t> kind;  // of the inner list
  Aligned<double> history;      // of the inner list, and a group of zeros behind
  Validity mid_valid, inner_valid;
  WallList walls;  // of the slab
};

// What a thread needs to make a list.
struct Scratch {
  Selection inner;
  Aligned<std::uint32_t> kind;
  Aligned<double> history;
  std::vector<std::uint32_t> place;  // by outer pair: where its history was
  std::vector<ContactPack> packs;    // of a section that is looked at
  OpenedContacts opened;             // of a section, for the ledger
  double excess = 0;
};

struct Engine {
  ContactLaws laws;
  Box box;
  Vec3 gravity;
  double dt = 0, overlap_ratio = 0, skin = 0;
  double cutoff = 0;  // distance of the centres of two large grains at which a pair is listed
  std::int64_t step = 0;
  bool equal_radii = true, one_kind = true;
  bool alike = true;  // the flowing grains: of one size, mass and moment of inertia
  std::size_t history_numbers = 3, constant_numbers = 0;
  std::vector<double> constants;  // of the laws, by pair of species
  std::vector<double> others;     // the same of laws that may be others

  Images images;
  Ring ring;
  Rows rows;
  bool keep_ledger = false;
  LedgerRows ledger;
  std::vector<Wall> walls;
  std::vector<std::int32_t> grain;    // of each row; -1 - w: wall w; nobody: neither
  std::vector<std::int32_t> species;  // of each row, if there are several
  std::vector<std::uint32_t> row;     // of each grain
  std::vector<Vec3> start;            // of each row: where it was when the outer list was made
  Vec3 frame;                         // velocity relative to which excursions are measured
  std::int64_t built_at = 0;          // step
  std::uint64_t left_behind = 0;      // fingerprint of the grains when the engine gave them back
  std::vector<Slab> slabs;
  std::vector<Section> sections;
  std::vector<Scratch> scratch;  // by thread

  bool has_grains() const { return rows.size() > 0; }
  std::size_t rows_beside() const { return 2 + walls.size(); }  // of a slab, no grains
  std::size_t wall_row(const Slab& slab, std::size_t wall) const { return slab.end + 2 + wall; }
};

inline constexpr std::int32_t nobody = std::numeric_limits<std::int32_t>::min();

// Where the constants of a pair begin, if there are several species.
inline std::uint32_t kind_of(const Engine& engine, std::size_t i, std::size_t j) {
  return static_cast<std::uint32_t>((engine.species[i] * engine.laws.species + engine.species[j]) *
                                    static_cast<std::int32_t>(engine.constant_numbers));
}

// Below this the plain engine is as fast.
inline constexpr std::int64_t fewest_grains = 64;

// False when the plain engine must do it: a few grains only, or a periodic box only a few grains wide.
bool supports(const DemState& state);

// While the engine has the grains it holds them and their contacts: the arrays x, v, omega, force, torque, `pairs` and
// `wall_contacts` of the state are empty. enter() takes them if the engine does not have them, and keeps its lists if the
// state is the one it left behind; leave() gives them back (nothing if it does not have them).
void enter(Engine& engine, DemState& state, const ContactLaws& laws);
void leave(Engine& engine, DemState& state);

// Takes the state and makes all lists, those that the state remembers if another engine made them before.
void load(Engine& engine, DemState& state, const ContactLaws& laws);

// Its parts: rows, slabs and the outer list from the places where grains start (`start`, by grain);
void arrange(Engine& engine, const Grains& grains, const std::vector<Vec3>& start);
// the largest acceleration of every slab, and the frame in which grains move least from here on;
void measure(Engine& engine);
// the other lists, with the springs of the pairs that touch;
void list_inner(Engine& engine, const PairList& touching);
// whether all this holds for the steps of one pass at least (else NumericalError).
void start_path(Engine& engine, const DemState& state);

// New lists here and now, grains in the order of space again.
void rebuild(Engine& engine, DemState& state);

// The pairs that touch with their springs, in the order of the sections.
PairList touching_pairs(const Engine& engine);

// Grains near walls, from where they start; the springs of those that touch, of the engine's and of the state's, and into
// the lists of the one and the arrays of the other.
void list_walls(Engine& engine, const Grains& grains);
std::vector<WallTouch> wall_touches(const Engine& engine);
std::vector<WallTouch> wall_touches(const DemState& state);
void remember_walls(Engine& engine, const std::vector<WallTouch>& touches);
void give_walls(const Engine& engine, DemState& state);

// As dem::prepare: the forces at t = 0.
void prepare(DemState& state, const ContactLaws& laws);

// As dem::advance_inside and dem::hand_back, for a state it supports.
void advance(DemState& state, const ContactLaws& laws, std::int64_t steps, const Watch& watch = {});
void hand_back(DemState& state);

// As dem::observe: with its own engine, or from inside one.
Observation observe(DemState& state, const ContactLaws& laws);
Observation observe(Engine& engine, const DemState& state);

// Adds the forces of all pairs of the inner lists to the rows once; springs move on by engine.dt.
void add_forces(Engine& engine);

// Makes the outer lists from the places where grains start. `grid`: its layers are the slabs.
void list_outer(Engine& engine, const Grains& grains, const neighbours::CellGrid& grid, const std::vector<Vec3>& start);

// Makes the lists of a section that no longer hold anew, at the present positions. With a ledger they keep the pairs that
// touched a step ago, so that their springs are not forgotten before their energy is entered.
void refresh(Engine& engine, std::size_t section, Scratch& scratch);

// Whether the outer list is sure to hold for the next epoch; measures the excursions of slabs where that is not known.
bool audit(Engine& engine);

}  // namespace bagnold::dem::fast

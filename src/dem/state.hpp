// The state of the particle model: plain data. Everything that decides the next step is here; exact checkpoints
// store the arrays that named_arrays() lists and nothing else.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "core/arrays.hpp"
#include "core/box.hpp"
#include "core/vec3.hpp"
#include "neighbours/cell_grid.hpp"

namespace bagnold::dem {

// Spheres, one array per quantity. Grains [0, flowing) move; [flowing, size) are fixed (base): infinite mass, v = 0,
// omega = 0. `mass` and `inertia` of a fixed grain are those of its material; only the integrator ignores it.
struct Grains {
  std::vector<Vec3> x;              // centres at t; periodic directions need not be wrapped
  std::vector<Vec3> v, omega;       // velocity, angular velocity at t - dt/2 (they enter the forces); before
                                    // the first step, at t
  std::vector<Vec3> force, torque;  // at t, gravity not included in `force`
  std::vector<double> diameter, mass, inertia;
  std::vector<std::int32_t> species;  // index into the contact model's species
  std::vector<std::int64_t> id;       // survives reordering; stable name of the grain in every output
  std::int64_t flowing = 0;
  std::int64_t size() const { return static_cast<std::int64_t>(diameter.size()); }
};

// An infinite frictional plane through `point`; grains are on the side `normal` points to (unit vector).
struct Wall {
  Vec3 point, normal;
  std::int32_t species = 0;
};

// One touching pair as observers see it: a function of the state (dem/contacts.hpp lists them on request).
struct Contact {
  std::int32_t i = 0;      // a flowing grain
  std::int32_t j = 0;      // another grain, or -1 - w for wall w
  Vec3 branch{};           // r_ij = x_i - x_j, minimum image; at a wall from the foot of the perpendicular to x_i
  Vec3 normal{};           // unit vector from j to i
  double overlap = 0;      // delta_n > 0
  Vec3 force{}, torque{};  // on i: force, and torque about x_i
  Vec3 torque_j{};         // on j about x_j
  Vec3 normal_force{};     // part of `force` along `normal`
  Vec3 spring{};           // tangential displacement delta_t
};

// Verlet list: every pair that can touch before some grain has moved by more than half the skin, each pair once, with
// the history of its contact. i < j, so i flows. Grouped by slab: see CellGrid.
struct PairList {
  std::vector<std::int32_t> i, j;
  std::vector<std::uint8_t> image;       // r_ij = x_i - x_j - image_shifts(box)[image]
  std::vector<std::uint8_t> touching;    // 1: in contact at the last evaluation
  std::vector<Vec3> spring, roll;        // tangential displacement and rolling angle of i relative to j; 0 if apart
  std::vector<std::int64_t> slab_begin;  // pairs of slab s: [slab_begin[s], slab_begin[s + 1])
  std::vector<Vec3> reference;           // x of the flowing grains when the list was made
  std::vector<double> origin;            // not empty: the fast engine was here, only touching pairs are listed, and
                                         // this is how it made its own lists (fast/exchange.cpp)
  std::int64_t size() const { return static_cast<std::int64_t>(i.size()); }
};

// History of grain-wall contacts: entry w * flowing + i for grain i at wall w.
struct WallContacts {
  std::vector<std::uint8_t> touching;
  std::vector<Vec3> spring, roll;
};

// Energy per mechanism: so far when it is an energy, per time when it is a power.
struct Dissipation {
  double normal = 0, tangential = 0, rolling = 0;  // dashpots
};

// Where energy went since t = 0. Only `wrapped` is kept unless DemState::keep_ledger.
struct Ledger {
  double wrapped = 0;       // what wrapping into the periodic box added to -sum m g . x
  Dissipation damped;       // energy taken by dashpots
  Dissipation power;        // their power at the last step; the integral is by the trapezoidal rule
  double sliding = 0;       // spring energy taken by Coulomb sliding
  double roll_sliding = 0;  // the same of rolling springs
  double opened = 0;        // energy left in tangential and rolling springs when contacts opened
};

// What makes stepping faster and follows from the state: never part of it, never copied with it.
struct EngineHandle {
  std::shared_ptr<void> held;
  EngineHandle() = default;
  EngineHandle(const EngineHandle&) {}
  EngineHandle(EngineHandle&&) = default;
  EngineHandle& operator=(const EngineHandle&) { return held.reset(), *this; }
  EngineHandle& operator=(EngineHandle&&) = default;
};

struct DemState {
  Grains grains;
  Box box;
  std::vector<Wall> walls;
  Vec3 gravity{};
  double dt = 0;
  std::int64_t step = 0;  // time = step * dt

  double skin = 0;                 // margin of the Verlet list; 0: chosen by prepare()
  bool keep_ledger = false;        // costs a second look at every contact
  std::int64_t reorder_every = 0;  // steps between spatial sorts of the grains (0: never); ids follow the grains
  double max_overlap_ratio = 0.5;  // overlap/radius beyond which a step fails

  PairList pairs;
  WallContacts wall_contacts;
  Ledger ledger;
  std::int64_t rebuilds = 0;      // of the Verlet list
  std::int64_t next_reorder = 0;  // step

  EngineHandle engine;

  double time() const { return static_cast<double>(step) * dt; }
};

// The exact state, for checkpoints and bitwise comparison. What it does not list (box, walls, gravity, dt and the
// options) comes from the input.
std::vector<NamedArray> named_arrays(DemState& state);

}  // namespace bagnold::dem

// Energies and the like from the rows and lists of the engine at work: sums in the order of rows and lists, slab after slab.
#include "dem/observe.hpp"

#include <algorithm>
#include <vector>

#include "core/parallel.hpp"
#include "dem/fast/pass.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace bagnold::dem::fast {

namespace {

// Of the grains of a slab and the contacts of its section.
struct Sums {
  double translational = 0, rotational = 0;
  double mass = 0;
  Vec3 place, momentum;  // times mass
  double normal = 0, tangential = 0, rolling = 0, overlap_ratio = 0;
  std::int64_t contacts = 0;
};

void add_grains(const Engine& engine, const Slab& slab, Sums& sums) {
  const double half = engine.step == 0 ? 0 : 0.5 * engine.dt;
  const auto vector = [](const double* p) { return Vec3{p[0], p[1], p[2]}; };
  for (std::size_t k = slab.begin; k < slab.moving_end; ++k) {
    const double *x = &engine.rows.position[position_doubles * k], *u = &engine.rows.velocity[velocity_doubles * k],
                 *f = &engine.rows.force[force_doubles * k];
    const double m = 1 / f[3], I = 1 / f[7];
    const Vec3 v = vector(u) + half * (f[3] * vector(f) + engine.gravity),
               omega = vector(u + 4) + (half * f[7]) * vector(f + 4);
    sums.translational += 0.5 * m * norm2(v);
    sums.rotational += 0.5 * I * norm2(omega);
    sums.mass += m;
    sums.place += m * vector(x);
    sums.momentum += m * v;
  }
}

// Eight contacts of which those that touch, or whose springs say so, count.
template <class Law>
void add_contacts(const Law& law, const laws::PairGeometry<Lanes>& geometry, const laws::PairSize<Lanes>& size,
                  const laws::PairHistory<Lanes>& history, const Mask& touching, Sums& sums) {
  const Lanes zero = 0.0, half = 0.5;
  const auto normal = law.normal.respond(geometry.overlap, size);
  const Lanes of_normal = law.normal.energy(max(zero, geometry.overlap), size);
  const Lanes of_tangential = half * law.tangential.stiffness(normal) * dot(history.spring, history.spring);
  Lanes of_rolling = zero;
  if constexpr (decltype(law.rolling)::active)
    of_rolling = half * law.rolling.stiffness(normal, size) * dot(history.roll, history.roll);
  const std::uint32_t lanes =
      to_integer(touching | (dot(history.spring, history.spring) > zero) | (dot(history.roll, history.roll) > zero));
  sums.contacts += __builtin_popcount(lanes);
  for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
    const int k = __builtin_ctz(left);
    sums.normal += of_normal[k];
    sums.tangential += of_tangential[k];
    sums.rolling += of_rolling[k];
  }
}

template <class K, class Tables>
void add_pairs(Engine& engine, const Tables& tables, Section& section, Sums& sums) {
  const Batches pairs = batches_of(section);
  const Lanes zero = 0.0;
  for (std::size_t p = 0; p < pairs.count; p += batch) {
    alignas(64) double in[K::collected * batch];
    K::collect(engine.rows.position.data(), engine.rows.velocity.data(), pairs.i + p, pairs.j + p, engine.images, in);
    const auto [motion, size] = K::encounter(in);
    const auto geometry = laws::pair_geometry(motion);
    const double* memory = pairs.history + p * K::history_numbers;
    laws::PairHistory<Lanes> history{load_vector(memory), {zero, zero, zero}};
    if constexpr (K::rolls) history.roll = load_vector(memory + 24);
    const Mask touching = geometry.overlap > zero;
    add_contacts(K::law_of(tables, input_of(engine), pairs, p), geometry, size, history, touching, sums);
    const Lanes smaller = motion.reach - abs(motion.size_difference);  // twice the smaller radius; 0 is possible
    sums.overlap_ratio =
        std::max(sums.overlap_ratio, largest(select(touching, Lanes(2.0) * geometry.overlap / smaller, zero)));
  }
}

template <class K, class Tables>
void add_walls(Engine& engine, const Tables& tables, Section& section, Sums& sums) {
  using AtWalls = WallKernel<Tables, K::one_kind>;
  const WallList& list = section.walls;
  const Lanes zero = 0.0;
  for (std::size_t b = 0, p = 0; b < list.batches.size(); ++b, p += batch) {
    const auto [wall, taken] = list.batches[b];
    const auto [motion, size, overlap, touching] =
        AtWalls::encounter(engine.rows, &list.i[p], &list.j[p], engine.walls[wall], taken);
    add_contacts(AtWalls::law_of(tables, input_of(engine), list, p), laws::pair_geometry(motion), size,
                 AtWalls::history_at(list, p), touching, sums);
    sums.overlap_ratio = std::max(sums.overlap_ratio, largest(select(touching, overlap / motion.reach, zero)));
  }
}

template <class K, class Tables>
void add_slabs(Engine& engine, const Tables& tables, std::vector<Sums>& sums) {
  parallel_for(
      static_cast<std::int64_t>(sums.size()),
      [&](std::int64_t s) {
        add_grains(engine, engine.slabs[at(s)], sums[at(s)]);
        add_pairs<K>(engine, tables, engine.sections[at(s)], sums[at(s)]);
        add_walls<K>(engine, tables, engine.sections[at(s)], sums[at(s)]);
      },
      engine.grain.size() >= 500);
}

}  // namespace

Observation observe(Engine& engine, const DemState& state) {
  std::vector<Sums> slabs(engine.slabs.size());
  with_kernel(engine, [&]<class K>(const auto& tables) { add_slabs<K>(engine, tables, slabs); });
  Observation seen;
  Energies& e = seen.energies;
  double mass = 0;
  Vec3 place;
  for (const Sums& s : slabs) {
    e.translational += s.translational;
    e.rotational += s.rotational;
    e.normal_spring += s.normal;
    e.tangential_spring += s.tangential;
    e.rolling_spring += s.rolling;
    mass += s.mass;
    place += s.place;
    seen.velocity += s.momentum;
    seen.contacts += s.contacts;
    seen.overlap_ratio = std::max(seen.overlap_ratio, s.overlap_ratio);
  }
  e.gravity = -dot(engine.gravity, place) - state.ledger.wrapped;
  seen.velocity *= 1 / mass;
  seen.centre_height = place.z / mass;
  return seen;
}

}  // namespace bagnold::dem::fast

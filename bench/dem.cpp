// Grain-steps per second and core of the particle engine in a chute flow, from 2 000 to 256 000 grains, and its memory
// per grain. The larger flows are copies of the smallest side by side, so all have the same contacts per grain.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <type_traits>
#include <variant>

#include "core/parallel.hpp"
#include "core/random.hpp"
#include "dem/algorithm.hpp"
#include "dem/contacts.hpp"

namespace {
using namespace bagnold;
using namespace bagnold::dem;

constexpr double tile = 10, layers = 20, angle = 24 * std::numbers::pi / 180;

ContactLaws chute_laws() {
  laws::Linear normal;
  normal.collision_time = 0.005;
  normal.restitution = 0.88;
  return compile(uniform_model({"grain"}, {normal, laws::LinearHistory{}, laws::NoRollingResistance{}}), 0.5);
}

double jitter(std::int64_t item, std::uint32_t draw) {
  return random::uniform(1, random::Stream::perturbation, static_cast<std::uint64_t>(item), draw) - 0.5;
}

void add_grain(Grains& g, const Vec3& x, const Vec3& v, const Vec3& omega) {
  g.x.push_back(x);
  g.v.push_back(v);
  g.omega.push_back(omega);
  g.diameter.push_back(1);
  g.mass.push_back(1);
  g.inertia.push_back(0.1);
  g.species.push_back(0);
  g.id.push_back(g.size() - 1);
}

DemState empty_chute(double length, double width) {
  DemState s;
  s.box = {{0, 0, 0}, {length, width, 1}, {true, true, false}};
  s.gravity = {std::sin(angle), 0, -std::cos(angle)};
  s.dt = 1e-4;
  s.reorder_every = 2000;
  return s;
}

// Twenty layers over a rough base, started with Bagnold's velocity profile and left to flow for 6 time units.
const DemState& flowing_tile() {
  static const DemState state = [] {
    DemState s = empty_chute(tile, tile);
    std::int64_t n = 0;
    for (double z = 0; z < layers; ++z)
      for (double y = 0; y < tile; ++y)
        for (double x = 0; x < tile; ++x, ++n)
          add_grain(
              s.grains, {x + 0.04 * jitter(n, 0), y + 0.04 * jitter(n, 1), z + 1 + 0.04 * jitter(n, 2)},
              {5 * (1 - std::pow(1 - z / layers, 1.5)) + 0.5 * jitter(n, 3), 0.5 * jitter(n, 4), 0.5 * jitter(n, 5)},
              {});
    s.grains.flowing = n;
    for (double y = 0; y < 12; ++y)
      for (double x = 0; x < 12; ++x, ++n)
        add_grain(s.grains, {x / 1.2 + 0.2 * jitter(n, 0), y / 1.2 + 0.2 * jitter(n, 1), 0.6 * jitter(n, 2) - 0.3}, {},
                  {});
    const ContactLaws laws = chute_laws();
    prepare(s, laws);
    advance(s, laws, 60000);
    return s;
  }();
  return state;
}

// nx times ny copies of the tile.
DemState chute(int nx, int ny) {
  const DemState& t = flowing_tile();
  DemState s = empty_chute(nx * tile, ny * tile);
  const auto copy = [&](std::int64_t begin, std::int64_t end) {
    for (int a = 0; a < nx; ++a)
      for (int b = 0; b < ny; ++b)
        for (std::int64_t i = begin; i < end; ++i) {
          const auto k = static_cast<std::size_t>(i);
          add_grain(s.grains, wrap(t.box, t.grains.x[k]) + Vec3{a * tile, b * tile, 0}, full_step_velocity(t, i),
                    full_step_omega(t, i));
        }
  };
  copy(0, t.grains.flowing);
  s.grains.flowing = s.grains.size();
  copy(t.grains.flowing, t.grains.size());
  return s;
}

double bytes(DemState& s) {
  double sum = 0;
  for (const NamedArray& named : named_arrays(s))
    std::visit(
        [&](const auto* a) {
          if constexpr (requires { a->data(); }) sum += static_cast<double>(a->capacity() * sizeof(*a->data()));
        },
        named.array);
  return sum;
}

void chute_steps(benchmark::State& bench) {
  set_threads(1);
  DemState s = chute(static_cast<int>(bench.range(0)), static_cast<int>(bench.range(1)));
  const ContactLaws laws = chute_laws();
  prepare(s, laws);
  advance(s, laws, 150);  // contacts have their springs back, the list has been rebuilt
  constexpr int chunk = 50;
  const std::int64_t rebuilds = s.rebuilds;
  for (auto _ : bench) advance(s, laws, chunk);
  const auto n = static_cast<double>(s.grains.flowing), steps = static_cast<double>(bench.iterations() * chunk);
  bench.counters["grains"] = n;
  bench.counters["grain_steps/s"] = benchmark::Counter(n * steps, benchmark::Counter::kIsRate);
  bench.counters["bytes/grain"] = bytes(s) / n;
  bench.counters["contacts/grain"] = static_cast<double>(contacts(s, laws).size()) / n;
  bench.counters["pairs/grain"] = static_cast<double>(s.pairs.size()) / n;
  bench.counters["steps/rebuild"] = steps / static_cast<double>(s.rebuilds - rebuilds);
}
BENCHMARK(chute_steps)
    ->Args({1, 1})
    ->Args({2, 1})
    ->Args({4, 2})
    ->Args({4, 4})
    ->Args({8, 4})
    ->Args({16, 8})
    ->Unit(benchmark::kMillisecond);

}  // namespace

// Cost of coarse-graining a chute flow while it runs: CPU time per grain of a sample, of 25 steps that are interrupted for it
// (half a collision time) and of 25 steps out of 50 in a row. `added` is what sampling every 25 steps adds to the run.
#include <benchmark/benchmark.h>

#include <ctime>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cg/from_dem.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "dem/algorithm.hpp"
#include "dem/contacts.hpp"

namespace {
using namespace bagnold;

constexpr std::int64_t steps_per_sample = 25;

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

dem::ContactLaws chute_laws() {
  laws::Linear normal;
  normal.collision_time = 0.005;
  normal.restitution = 0.88;
  return dem::compile(dem::uniform_model({"grain"}, {normal, laws::LinearHistory{}, laws::NoRollingResistance{}}), 0.5);
}

// 4 000 grains over a dense layer of fixed ones, sheared from a lattice for a few time units.
dem::DemState flow(const dem::ContactLaws& laws) {
  dem::DemState s;
  s.box = {{0, 0, 0}, {20, 10, 1}, {true, true, false}};
  s.gravity = {std::sin(24 * std::numbers::pi / 180), 0, -std::cos(24 * std::numbers::pi / 180)};
  s.dt = 1e-4;
  s.reorder_every = 2000;
  std::uint64_t item = 0;
  for (int k = 0; k <= 20; ++k)
    for (int j = 0; j < (k < 20 ? 10 : 15); ++j)
      for (int i = 0; i < (k < 20 ? 20 : 30); ++i, ++item) {
        const auto u = [&](std::uint32_t draw) {
          return random::uniform(2, random::Stream::perturbation, item, draw) - 0.5;
        };
        const bool fixed = k == 20;
        const double z = fixed ? 0 : k + 1;
        const double spacing = fixed ? 2.0 / 3 : 1;
        s.grains.x.push_back({spacing * i + 0.04 * u(0), spacing * j + 0.04 * u(1), z + (fixed ? 0.2 : 0.04) * u(2)});
        s.grains.v.push_back(fixed ? Vec3{} : Vec3{0.25 * z + 0.5 * u(3), 0.5 * u(4), 0.5 * u(5)});
        s.grains.omega.push_back({});
        s.grains.diameter.push_back(1);
        s.grains.mass.push_back(1);
        s.grains.inertia.push_back(0.1);
        s.grains.species.push_back(0);
        s.grains.id.push_back(static_cast<std::int64_t>(item));
        s.grains.flowing += !fixed;
      }
  dem::prepare(s, laws);
  dem::advance(s, laws, 30000);
  return s;
}

void streaming(benchmark::State& bench) {
  set_threads(1);
  const auto laws = chute_laws();
  dem::DemState s = flow(laws);
  cg::BlockedProfile profile(laws::CgGaussian{0.25}, 0.0625, s.box, 40000);
  const auto timed = [](double& total, auto&& work) {
    const double begin = cpu_seconds();
    work();
    total += cpu_seconds() - begin;
  };
  double undisturbed = 1e9, stepping = 1e9, sampling = 1e9;  // best of all rounds: the machine may be busy
  for (auto _ : bench) {
    double plain = 0, run = 0, sample = 0;
    for (int k = 0; k < 10; ++k) timed(plain, [&] { dem::advance(s, laws, 2 * steps_per_sample); });
    for (int k = 0; k < 20; ++k) {
      timed(run, [&] { dem::advance(s, laws, steps_per_sample); });
      timed(sample, [&] { profile.add(s, laws); });
    }
    undisturbed = std::min(undisturbed, plain / 20);
    stepping = std::min(stepping, run / 20);
    sampling = std::min(sampling, sample / 20);
  }
  const double per_grain = 1e9 / static_cast<double>(s.grains.flowing);
  bench.counters["ns_25_of_50_steps"] = undisturbed * per_grain;
  bench.counters["ns_25_steps"] = stepping * per_grain;
  bench.counters["ns_sample"] = sampling * per_grain;
  bench.counters["added"] = (stepping + sampling) / undisturbed - 1;
  bench.counters["contacts_per_grain"] =
      static_cast<double>(dem::contacts(s, laws).size()) / static_cast<double>(s.grains.flowing);
}
BENCHMARK(streaming)->Iterations(20)->Unit(benchmark::kMillisecond);

}  // namespace

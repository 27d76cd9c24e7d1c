// The particle engine piece by piece, one core: whole steps of both engines from 4 000 to 256 000 grains, the contact
// kernel, the choice of the inner and the mid list, and making all lists anew. `bench_flow` compares whole runs.
#include <benchmark/benchmark.h>

#include "chute_flow.hpp"
#include "core/parallel.hpp"
#include "dem/fast/engine.hpp"

namespace {
using namespace bagnold;
using namespace bagnold::dem;
using benchmark::Counter;

DemState developed(int nx, int ny) {
  set_threads(1);
  static const auto grains = bench::developed_flow();
  DemState s = bench::make_state(grains, nx, ny);
  prepare(s, bench::linear_laws());
  advance(s, bench::linear_laws(), 100);  // contacts have their springs
  return s;
}

template <class Advance>
void steps(benchmark::State& bench, Advance&& advance_by) {
  DemState s = developed(static_cast<int>(bench.range(0)), static_cast<int>(bench.range(1)));
  const ContactLaws laws = bench::linear_laws();
  constexpr int chunk = 48;
  advance_by(s, laws, chunk);
  for (auto _ : bench) advance_by(s, laws, chunk);
  const auto n = static_cast<double>(s.grains.flowing);
  bench.counters["grains"] = n;
  bench.counters["grain_steps/s"] = Counter(n * chunk, Counter::kIsIterationInvariantRate);
  bench.counters["contacts/grain"] = static_cast<double>(contacts(s, laws).size()) / n;
}
void fast_steps(benchmark::State& bench) {
  steps(bench, [](auto&&... a) { advance(a...); });
}
void plain_steps(benchmark::State& bench) {
  steps(bench, [](auto&&... a) { advance_plain(a...); });
}
BENCHMARK(fast_steps)->Args({1, 1})->Args({2, 2})->Args({4, 2})->Args({8, 8})->Unit(benchmark::kMillisecond);
BENCHMARK(plain_steps)->Args({1, 1})->Args({2, 2})->Args({4, 2})->Args({8, 8})->Unit(benchmark::kMillisecond);

fast::Engine loaded(DemState& s) {
  fast::Engine engine;
  s.pairs.origin.clear();
  fast::load(engine, s, bench::linear_laws());
  return engine;
}

// Forces of all pairs of the inner lists, as in every step.
void contact_kernel(benchmark::State& bench) {
  DemState s = developed(1, 1);
  const auto touching = static_cast<double>(contacts(s, bench::linear_laws()).size());
  fast::Engine engine = loaded(s);
  double pairs = 0;
  for (const fast::Section& section : engine.sections) pairs += static_cast<double>(section.inner.count);
  for (auto _ : bench) fast::add_forces(engine);
  bench.counters["pairs/s"] = Counter(pairs, Counter::kIsIterationInvariantRate);
  bench.counters["pairs/contact"] = pairs / touching;
}
BENCHMARK(contact_kernel)->Unit(benchmark::kMicrosecond);

// Which pairs of a longer list may touch: inner from mid, mid from outer.
void selection(benchmark::State& bench, bool inner) {
  DemState s = developed(1, 1);
  fast::Engine engine = loaded(s);
  fast::Selection out;
  double seen = 0;
  const auto from = [&](const fast::Section& section) {
    return inner ? section.mid.span()
                 : fast::PairSpan{section.outer_i.data(), section.outer_j.data(), nullptr, section.outer_count};
  };
  for (const fast::Section& section : engine.sections) seen += static_cast<double>(from(section).count);
  const double horizon = (inner ? fast::inner_steps : fast::mid_steps) * engine.dt;
  for (auto _ : bench)
    for (const fast::Section& section : engine.sections) {
      fast::select(engine.rows, engine.images, from(section), horizon, 0,
                   (inner ? section.inner_valid : section.mid_valid).margin, out);
      benchmark::DoNotOptimize(out.count);
    }
  bench.counters["pairs/s"] = Counter(seen, Counter::kIsIterationInvariantRate);
}
void inner_list(benchmark::State& bench) { selection(bench, true); }
void mid_list(benchmark::State& bench) { selection(bench, false); }
BENCHMARK(inner_list)->Unit(benchmark::kMicrosecond);
BENCHMARK(mid_list)->Unit(benchmark::kMicrosecond);

// Sorting the grains and making all lists.
void all_lists(benchmark::State& bench) {
  DemState s = developed(1, 1);
  fast::Engine engine = loaded(s);
  for (auto _ : bench) fast::rebuild(engine, s);
  bench.counters["grains/s"] = Counter(static_cast<double>(s.grains.flowing), Counter::kIsIterationInvariantRate);
}
BENCHMARK(all_lists)->Unit(benchmark::kMicrosecond);

}  // namespace

// What sampling depth profiles every 25 steps (half a collision time) adds to a chute flow, for the fast engine and for the
// plain one: two copies of the same developed flow advance in turn, one of them watched. CPU time per grain and 25 steps;
// `added` is the median over the rounds of watched/alone - 1, which a busy machine disturbs least.
#include <benchmark/benchmark.h>

#include <ctime>

#include <algorithm>
#include <vector>

#include "cg/from_dem.hpp"
#include "chute_flow.hpp"
#include "core/parallel.hpp"
#include "dem/algorithm.hpp"
#include "dem/contacts.hpp"
#include "steady_flow.hpp"

namespace {
using namespace bagnold;

constexpr std::int64_t steps_per_sample = 25;

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

// `advance(state, observer)`: 20 samples long, watched if there is an observer.
template <class Advance>
void compare(benchmark::State& bench, const std::vector<bench::Grain>& flow, int copies, const Advance& advance) {
  set_threads(1);
  const auto laws = bench::linear_laws();
  dem::DemState watched = bench::make_state(flow, copies, 1);
  dem::prepare(watched, laws);
  dem::advance(watched, laws, 2000);
  dem::DemState alone = watched;
  cg::ProfileObserver observer({.kernel = laws::CgGaussian{0.25},
                                .first_step = watched.step,
                                .last_step = watched.step + 25 * 40000,
                                .every = steps_per_sample},
                               watched.box);
  const double per_sample = 1e9 / static_cast<double>(20 * watched.grains.flowing);
  const auto timed = [&](dem::DemState& state, cg::ProfileObserver* by) {
    const double begin = cpu_seconds();
    advance(state, laws, by);
    return (cpu_seconds() - begin) * per_sample;
  };
  timed(watched, &observer);
  std::vector<double> with, without, ratio;
  for (auto _ : bench) {
    without.push_back(timed(alone, nullptr));
    with.push_back(timed(watched, &observer));
    ratio.push_back(with.back() / without.back() - 1);
  }
  bench.counters["ns_25_steps"] = *std::min_element(without.begin(), without.end());
  bench.counters["ns_watched"] = *std::min_element(with.begin(), with.end());
  bench.counters["added"] = median(ratio);
  bench.counters["contacts_per_grain"] =
      static_cast<double>(dem::contacts(watched, laws).size()) / static_cast<double>(watched.grains.flowing);
}

void advance_fast(dem::DemState& state, const dem::ContactLaws& laws, cg::ProfileObserver* by) {
  dem::advance(state, laws, 20 * steps_per_sample, by != nullptr ? by->watch(laws) : dem::Watch{});
}
// cases/chute.toml once it is steady.
void fast_steady(benchmark::State& bench) { compare(bench, bench::steady_flow(), 1, advance_fast); }
BENCHMARK(fast_steady)->Iterations(60)->Unit(benchmark::kMillisecond);

void fast(benchmark::State& bench) {
  compare(bench, bench::developed_flow(), static_cast<int>(bench.range(0)), advance_fast);
}
BENCHMARK(fast)->Arg(1)->Arg(8)->Iterations(60)->Unit(benchmark::kMillisecond);

void plain(benchmark::State& bench) {
  compare(bench, bench::developed_flow(), 1,
          [](dem::DemState& state, const dem::ContactLaws& laws, cg::ProfileObserver* by) {
            for (int k = 0; k < 20; ++k) {
              dem::advance_plain(state, laws, steps_per_sample);
              if (by != nullptr) by->watch(laws).plain(state);
            }
          });
}
BENCHMARK(plain)->Iterations(20)->Unit(benchmark::kMillisecond);

}  // namespace

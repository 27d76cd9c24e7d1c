// Particle-steps per second of the explicit continuum model as the paper has it (minatti2015: mass, momentum, mu(i),
// phi(i), the cubic, regularised viscosity; h/dp = 1.3) in the incline with its steady velocity profile and disordered
// particles, from 2 500 to 1 000 000 of them, and with two threads; then row 3 of table 3, explicit against implicit.
// CPU time of one thread, best of rounds in turn; wall time for threads. Appends to performance-sph.csv.
//
//   bench_sph                            everything, row 3 for the first 0.03 s
//   bench_sph END [MEMBERS [DISORDER]]   row 3 only, up to t = END (0.8 is all of it; an explicit run takes minutes), means of
//                                        MEMBERS runs, particles moved by up to DISORDER (0.0005) spacings at the start
#include <fmt/core.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "core/random.hpp"
#include "core/version.hpp"
#include "scenario/continuum_column.hpp"
#include "scenario/inclined_plane.hpp"
#include "sph/algorithm.hpp"
#include "sph/observe.hpp"

namespace {
using namespace bagnold;
using namespace bagnold::sph;

struct Simulation {
  Model model;
  State state;
  Work work;
};

double cpu() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  return static_cast<double>(use.ru_utime.tv_sec + use.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(use.ru_utime.tv_usec + use.ru_stime.tv_usec);
}
double thread_cpu() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}
double wall() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }
std::string host() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

// rows x rows particles, moved at random by up to a tenth of a spacing, sliding at their steady speed.
Simulation incline(int rows) {
  Simulation s;
  s.model.material.rheology = laws::rheology::MuI{20.90, 32.76, 0.279};
  s.model.material.grain_diameter = 5e-3;
  s.model.material.eos = laws::eos::CompressibleGrains{800, 1.5e-5};
  s.model.material.regularisation = laws::regularisation::Minatti2015{190, 1};
  const scenario::InclinedPlane plane{.spacing = 0.1 / rows};
  set_geometry(plane, s.model);
  s.state.particles = make_particles(plane, s.model);
  const auto flow = steady_flow(plane, s.model);
  Particles& p = s.state.particles;
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    for (std::size_t d : {0, 1})
      p.x[d][i] += 0.2 * plane.spacing *
                   (random::uniform(1, random::Stream::perturbation, i, static_cast<std::uint32_t>(d)) - 0.5);
    p.v[0][i] = flow.velocity(p.x[1][i]);
  }
  initialise(s.state, s.work, s.model);
  return s;
}

void advance(Simulation& s, std::int64_t steps) {
  for (std::int64_t k = 0; k < steps; ++k) step(s.state, s.work, s.model);
}

// Particle-steps per second of `clock` over `steps`.
template <class Clock>
double speed(Simulation& s, std::int64_t steps, Clock&& clock) {
  const double before = clock();
  advance(s, steps);
  return static_cast<double>(s.state.particles.size() * steps) / (clock() - before);
}

struct Row {
  std::int64_t particles;
  double speed;
};

std::vector<Row> sizes() {
  struct Size {
    Simulation s;
    std::int64_t steps;
    double best = 0;
  };
  std::vector<Size> all;
  for (const auto& [rows, steps] : {std::array{50, 800}, {100, 200}, {316, 30}, {1000, 10}})
    all.push_back({incline(rows), steps});
  for (Size& size : all) advance(size.s, 20);
  for (int round = 0; round < 6; ++round)
    for (Size& size : all) size.best = std::max(size.best, speed(size.s, size.steps, cpu));
  std::vector<Row> rows;
  for (const Size& size : all) rows.push_back({size.s.state.particles.size(), size.best});
  return rows;
}

// Two threads beside one, best of rounds in turn: speed by the wall clock, which other load spoils, and CPU time, which
// holds what the second thread spends waiting.
struct TwoThreads {
  double faster = 0, cpu = 0;
};
TwoThreads two_threads() {
  Simulation s = incline(316);
  std::array<double, 2> took, spent;
  took.fill(std::numeric_limits<double>::infinity());
  spent = took;
  for (int round = 0; round < 4; ++round)
    for (const std::size_t k : {0, 1}) {
      set_threads(static_cast<int>(k) + 1);
      advance(s, 2);
      const double before = cpu(), from = wall();
      advance(s, 50);
      took[k] = std::min(took[k], wall() - from);
      spent[k] = std::min(spent[k], cpu() - before);
    }
  set_threads(1);
  return {took[0] / took[1], spent[1] / spent[0]};
}

// Row 3 of table 3, axisymmetric, improved formulation, `disorder` spacings off its lattice at random.
Simulation row3(Stepping stepping, double disorder, std::uint64_t seed) {
  Simulation s;
  s.model.viscous = laws::viscous::Variational{.bulk = 2};
  s.model.stepping = stepping;
  s.model.numerics = {.cfl = 0.4,  // explicit: 0.04 rho h^2/eta
                      .shifting = 10,
                      .volume_correction = 1,
                      .density_diffusion = 0.03,
                      .base_friction = 1,
                      .cg_tolerance = 3e-4};
  const scenario::ContinuumColumn column{.disorder = disorder};
  const auto geometry = scenario::ColumnGeometry::axisymmetric;
  set_geometry(column, geometry, s.model);
  s.state.particles = make_particles(column, geometry, s.model, seed);
  initialise(s.state, s.work, s.model);
  return s;
}

// Cost, both fronts and radius of 90 % of the mass at eight times up to `end`.
struct Solution {
  std::array<double, 8> connected{}, layer{}, radius{}, evaluations{};
  double seconds = 0;
};

Solution solve(Simulation s, double end) {
  Solution out;
  for (std::size_t k = 0; k < out.radius.size(); ++k) {
    const double before = thread_cpu();
    while (s.state.time < end * static_cast<double>(k + 1) / 8) step(s.state, s.work, s.model);
    out.seconds += thread_cpu() - before;
    refresh(s.state, s.work, s.model);
    const Front front = find_front(s.state, s.work, s.model);
    out.connected[k] = front.connected;
    out.layer[k] = front.layer;
    out.radius[k] = radii(s.state, s.model).at(0.9);
    out.evaluations[k] = static_cast<double>(s.state.force_evaluations);
  }
  return out;
}

struct Mean {
  double value = 0, error = 0;  // of the mean itself; no error from one value
};
template <class Value>
Mean mean(std::size_t n, Value&& value) {
  double sum = 0, squares = 0;
  for (std::size_t m = 0; m < n; ++m) sum += value(m);
  const double average = sum / static_cast<double>(n);
  for (std::size_t m = 0; m < n; ++m) squares += (value(m) - average) * (value(m) - average);
  return {average, n > 1 ? std::sqrt(squares / static_cast<double>(n * (n - 1))) : 0.0};
}

// Fronts hang on single particles: moving all of them by half a thousandth of a spacing at the start moves a front by 2 %
// later on, and the radius of 90 % of the mass by 0.3 %. So explicit and implicit are compared in the mean of `members` runs.
void print_row3(double end, std::size_t members, double disorder, int threads) {
  std::vector<Solution> implicit(members), plain(members);
  set_threads(threads);
  parallel_for(static_cast<std::int64_t>(2 * members),
               [&](std::int64_t k) {  // the explicit ones, which take long, first
                 const bool is_plain = static_cast<std::size_t>(k) < members;
                 const std::size_t m = static_cast<std::size_t>(k) % members;
                 (is_plain ? plain : implicit)[m] =
                     solve(row3(is_plain ? Stepping::explicit_euler : Stepping::implicit, disorder, m + 1), end);
               });

  fmt::print(
      "row 3 of table 3, {} run(s) each: viscous force evaluations; front [m] of the connected material, of the layer, "
      "radius of "
      "90 % of the mass, implicit and explicit\n",
      members);
  const auto average = [&](const std::vector<Solution>& runs, const std::array<double, 8> Solution::*what,
                           std::size_t k) { return mean(members, [&](std::size_t m) { return (runs[m].*what)[k]; }); };
  for (std::size_t k = 0; k < 8; ++k) {
    const double few = average(implicit, &Solution::evaluations, k).value,
                 many = average(plain, &Solution::evaluations, k).value;
    fmt::print("  t = {:6.4f} s: {:6.0f}, {:7.0f}: {:4.1f} x fewer", end * static_cast<double>(k + 1) / 8, few, many,
               many / few);
    for (const auto what : {&Solution::connected, &Solution::layer, &Solution::radius}) {
      const Mean a = average(implicit, what, k), b = average(plain, what, k);
      fmt::print("; {:.5f} {:.5f} ({:+.2f} +- {:.2f} %)", a.value, b.value, 100 * (a.value / b.value - 1),
                 100 * std::hypot(a.error, b.error) / b.value);
    }
    fmt::print("\n");
  }
  const double quick = mean(members, [&](std::size_t m) { return implicit[m].seconds; }).value,
               slow = mean(members, [&](std::size_t m) { return plain[m].seconds; }).value;
  fmt::print("  implicit {:.2f} s, explicit {:.2f} s of CPU time: {:.1f} times faster\n", quick, slow, slow / quick);
}

}  // namespace

int main(int argc, char** argv) {
  const int cores = threads();
  set_threads(1);
  if (argc > 1) {
    const std::size_t members = argc > 2 ? std::stoul(argv[2]) : 1;
    print_row3(std::stod(argv[1]), members,
               argc > 3      ? std::stod(argv[3])
               : members > 1 ? 5e-4
                             : 0,
               members > 1 ? cores : 1);
    return 0;
  }
  std::ofstream csv("performance-sph.csv", std::ios::app);
  if (csv.tellp() == 0) csv << "host,commit,what,value\n";
  const auto record = [&](const std::string& what, double value) {
    csv << fmt::format("{},{},{},{:.4g}\n", host(), git_hash(), what, value);
  };
  double fastest = 0, slowest = std::numeric_limits<double>::infinity();
  for (const Row& row : sizes()) {
    fmt::print("{:8d} particles: {:5.2f} M particle-steps/s and core\n", row.particles, 1e-6 * row.speed);
    record(fmt::format("sph_particle_steps_per_s_{}", row.particles), row.speed);
    fastest = std::max(fastest, row.speed), slowest = std::min(slowest, row.speed);
  }
  const TwoThreads scaling = two_threads();
  fmt::print(
      "slowest size {:.2f} times the cost per particle of the fastest; 99856 particles on two threads {:.2f} times as "
      "fast as on one, at {:.2f} times the CPU time\n",
      fastest / slowest, scaling.faster, scaling.cpu);
  record("sph_two_threads", scaling.faster);
  print_row3(0.03, 1, 0, 1);
}

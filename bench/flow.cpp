// Whole runs of chute flows, one core, CPU time: the fast engine, the plain one and LAMMPS in rounds by turns, then
// unequal grains and Hertz contacts against equal grains with the linear law, threads and memory. Prints tables and
// appends to performance.csv in the working directory.
//
//   bench_flow [--quick] [STATE]   STATE: another flow for the first table (format: chute_flow.hpp)
//                                  --quick: without the steady flow, which takes minutes to reach once
#include <sys/wait.h>
#include <unistd.h>
#include <x86intrin.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <thread>

#include "chute_flow.hpp"
#include "core/memory.hpp"
#include "core/parallel.hpp"
#include "core/variant.hpp"
#include "core/version.hpp"
#include "lammps.hpp"
#include "steady_flow.hpp"

namespace {
using namespace bagnold;
using namespace bagnold::bench;
using dem::ContactLaws;
using dem::DemState;

double wall() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// Cycles of the time-stamp counter (constant rate, the nominal frequency of the processor) in a second.
double cycles_per_second() {
  const double begin = wall();
  const std::uint64_t first = __rdtsc();
  while (wall() - begin < 0.05) continue;
  return static_cast<double>(__rdtsc() - first) / (wall() - begin);
}

std::string host() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Row {
  std::string flow;
  double grains = 0, contacts = 0;                                // touching pairs per flowing grain
  double fast = 0, plain = 0, granular = 0, hooke = 0, skin = 0;  // grain-steps per CPU second; LAMMPS' best skin
  double ratio = 0;                                               // fast/hooke, median of the rounds at that skin
  double steps_per_rebuild = 0, rebuild_part = 0;
};

// A state on its way: springs are there, lists are in use.
DemState warmed(const DemState& start, const ContactLaws& laws) {
  DemState s = start;
  prepare(s, laws);
  advance(s, laws, 100);
  return s;
}

void count_contacts(Row& row, const DemState& s) {
  row.grains = static_cast<double>(s.grains.flowing);
  row.contacts = static_cast<double>(std::count(s.pairs.touching.begin(), s.pairs.touching.end(), 1)) / row.grains;
}

// One round of the fast engine from the start of the flow; returns its speed.
double run_fast(Row& row, const DemState& start, const ContactLaws& laws, int steps) {
  DemState s = warmed(start, laws);
  const std::int64_t rebuilds = s.rebuilds;
  const double begin = cpu(RUSAGE_SELF);
  advance(s, laws, steps);
  const double seconds = cpu(RUSAGE_SELF) - begin;
  const double speed = static_cast<double>(s.grains.flowing) * steps / seconds;
  if (speed < row.fast) return speed;
  count_contacts(row, s);
  row.fast = speed;
  const double made = static_cast<double>(s.rebuilds - rebuilds);
  row.steps_per_rebuild = made > 0 ? steps / made : 0;
  const double rebuild = cpu(RUSAGE_SELF);
  s.engine = {};
  s.pairs.origin.clear();
  advance(s, laws, 0);  // makes all lists
  row.rebuild_part = made * (cpu(RUSAGE_SELF) - rebuild) / seconds;
  return speed;
}

void run_plain(Row& row, const DemState& start, const ContactLaws& laws, int steps) {
  DemState s = start;
  prepare(s, laws);
  advance_plain(s, laws, 20);
  const double begin = cpu(RUSAGE_SELF);
  advance_plain(s, laws, steps);
  row.plain = static_cast<double>(s.grains.flowing) * steps / (cpu(RUSAGE_SELF) - begin);
}

// Speeds are the best of rounds in turn, other load only slows; ratios are taken round by round, because the speed of a machine
// may change in between.
Row compare(const std::string& name, const DemState& start, const ContactLaws& laws, int steps, bool lammps) {
  Row row{.flow = name};
  run_plain(row, start, laws, steps / 10);
  if (lammps) row.granular = lammps_speed(start, Style::granular, 0.15, steps / 2);
  for (const double skin : {0.1, 0.15, 0.2, 0.3}) {
    run_fast(row, start, laws, steps);
    const double speed = lammps ? lammps_speed(start, Style::hooke, skin, steps) : 0;
    if (speed > row.hooke) row.hooke = speed, row.skin = skin;
  }
  std::vector<double> ratios;
  for (int round = 0; round < 5; ++round) {
    const double fast = run_fast(row, start, laws, steps);
    if (!lammps) continue;
    const double hooke = lammps_speed(start, Style::hooke, row.skin, steps);
    row.hooke = std::max(row.hooke, hooke);
    ratios.push_back(fast / hooke);
  }
  if (lammps) row.ratio = median(ratios);
  return row;
}

void print(const Row& r, double hz) {
  fmt::print(
      "{:>10} {:7.0f} grains: fast {:6.1f} M grain-steps/s, plain {:5.1f}, lmp granular {:5.1f}, hooke {:5.1f} (skin "
      "{}), fast/hooke {:4.2f};\n{:19} {:.2f} contacts per grain, {:.0f} cycles per contact and step, {:.0f} steps per "
      "rebuild, rebuilds take {:.1f} %\n",
      r.flow, r.grains, r.fast * 1e-6, r.plain * 1e-6, r.granular * 1e-6, r.hooke * 1e-6, r.skin, r.ratio, "",
      r.contacts, hz / r.fast / r.contacts, r.steps_per_rebuild, 100 * r.rebuild_part);
}

// Cost per grain-step of a flow over that of another, by CPU time: the median over many short rounds in turn, because the
// speed of a machine may change in between.
double relative_cost(const DemState& a, const ContactLaws& a_laws, const DemState& b, const ContactLaws& b_laws) {
  constexpr int rounds = 21, steps = 1500;
  const auto seconds = [](const DemState& start, const ContactLaws& laws) {
    DemState s = warmed(start, laws);
    const double begin = cpu(RUSAGE_SELF);
    advance(s, laws, steps);
    return (cpu(RUSAGE_SELF) - begin) / static_cast<double>(s.grains.flowing);
  };
  std::vector<double> ratios;
  for (int round = 0; round < rounds; ++round) {
    const double first = seconds(a, a_laws);
    ratios.push_back(first / seconds(b, b_laws));
  }
  return median(ratios);
}

// By wall time, medians of several rounds in turn.
struct SpeedUp {
  double threads = 0;   // of two threads over one
  double separate = 0;  // of two flows at once, each on one thread of its own: what the machine has to give
};
SpeedUp speed_up(const DemState& start, const ContactLaws& laws, int steps) {
  const auto timed = [&](auto&& work) {
    const double begin = wall();
    work();
    return wall() - begin;
  };
  std::vector<double> threads, separate;
  for (int round = 0; round < 9; ++round) {
    std::array<double, 2> took{};
    for (const int team : {1, 2}) {
      set_threads(team);
      DemState s = warmed(start, laws);
      took[static_cast<std::size_t>(team - 1)] = timed([&] { advance(s, laws, steps); });
    }
    threads.push_back(took[0] / took[1]);
    set_threads(1);
    std::array<DemState, 2> flows{warmed(start, laws), warmed(start, laws)};
    separate.push_back(2 * took[0] / timed([&] {
                         std::array<std::thread, 2> both;
                         for (std::size_t k = 0; k < 2; ++k)
                           both[k] = std::thread([&, k] {
                             set_threads(1);
                             advance(flows[k], laws, steps);
                           });
                         for (std::thread& t : both) t.join();
                       }));
  }
  return {median(threads), median(separate)};
}

// Peak memory of a process that runs the flow, in bytes. Forked before this process has grown or made threads.
double peak_memory(const std::vector<Grain>& grains, const ContactLaws& laws, int nx, int ny) {
  const pid_t child = fork();
  if (child == 0) {
    DemState s = make_state(grains, nx, ny);
    prepare(s, laws);
    advance(s, laws, 40);
    _exit(0);
  }
  int status = 0;
  rusage use{};
  wait4(child, &status, 0, &use);
  return 1024.0 * static_cast<double>(use.ru_maxrss);
}

}  // namespace

int main(int argc, char** argv) {
  bool quick = false;
  std::string given;
  for (int k = 1; k < argc; ++k)
    if (std::strcmp(argv[k], "--quick") == 0)
      quick = true;
    else
      given = argv[k];
  set_threads(1);
  return_large_arrays();
  const ContactLaws linear = linear_laws(), hertz = hertz_laws();
  const std::vector<Grain> developed = given.empty() ? developed_flow() : read(given);
  if (developed.empty()) return fmt::print(stderr, "no grains in {}\n", given), 2;

  const double larger = peak_memory(developed, linear, 8, 8), smaller = peak_memory(developed, linear, 4, 2);
  const double bytes = (larger - smaller) / (56 * static_cast<double>(developed.size()));

  fmt::print("memory: {:.0f} bytes per grain (base included) at the peak, contacts and lists included\n", bytes);

  const bool lammps = lammps_is_there();
  const DemState one = make_state(developed, 1, 1);
  for (const Style style : {Style::granular, Style::hooke})
    if (lammps && !lammps_agrees(one, linear, style)) return fmt::print(stderr, "LAMMPS runs another flow\n"), 1;

  std::vector<Row> rows;
  const double hz = cycles_per_second();
  const auto add = [&](Row row) {
    print(row, hz);
    rows.push_back(std::move(row));
  };
  add(compare("developed", one, linear, 3000, lammps));
  if (!quick) add(compare("steady", make_state(steady_flow(), 1, 1), linear, 3000, lammps));
  add(compare("developed", make_state(developed, 4, 2), linear, 300, lammps));
  add(compare("developed", make_state(developed, 8, 8), linear, 150, lammps));
  const Row unequal = compare("unequal", make_state(unequal_flow(), 1, 1), linear, 3000, false);
  // Both laws from the same flow, so that they have about the same contacts.
  const Row later = compare("linear", make_state(later_flow("linear", linear), 1, 1), linear, 3000, false);
  const Row like = compare("hertz", make_state(later_flow("hertz-contacts", hertz), 1, 1), hertz, 3000, false);
  add(unequal);
  add(later);
  add(like);
  const auto cost = [&](const Row& r, const Row& plain, double ratio) {
    fmt::print(
        "{:>10}: {:.2f} times the cost per grain-step of equal grains with the linear law, {:.2f} times per contact\n",
        r.flow, ratio, ratio * plain.contacts / r.contacts);
  };
  cost(unequal, rows[0], relative_cost(make_state(unequal_flow(), 1, 1), linear, one, linear));
  cost(like, later,
       relative_cost(make_state(later_flow("hertz-contacts", hertz), 1, 1), hertz,
                     make_state(later_flow("linear", linear), 1, 1), linear));

  std::array<double, 2> faster{1, 1};
  if (std::thread::hardware_concurrency() > 1)
    for (const std::size_t k : {0, 1}) {
      const SpeedUp s = k == 0 ? speed_up(one, linear, 3000) : speed_up(make_state(developed, 4, 2), linear, 500);
      faster[k] = s.threads;
      fmt::print("two threads with {} grains: {:.2f} times as fast as one; two separate flows at once: {:.2f}\n",
                 k == 0 ? "4 000" : "32 000", s.threads, s.separate);
    }

  std::ofstream csv("performance.csv", std::ios::app);
  if (csv.tellp() == 0)
    csv << "host,commit,variant,flow,grains,contacts_per_grain,fast_grain_steps_per_s,plain,lammps_granular,lammps_hooke,"
           "lammps_skin,ratio,cycles_per_contact,steps_per_rebuild,rebuild_part,speed_up_2_threads_4k,"
           "speed_up_2_threads_32k,bytes_per_grain\n";
  for (const Row& r : rows)
    csv << fmt::format(
        "{},{},{},{},{},{:.3g},{:.4g},{:.4g},{:.4g},{:.4g},{},{:.4g},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g},{:.0f}\n", host(),
        git_hash(), name(variant()), r.flow, r.grains, r.contacts, r.fast, r.plain, r.granular, r.hooke, r.skin, r.ratio,
        hz / r.fast / r.contacts, r.steps_per_rebuild, r.rebuild_part, faster[0], faster[1], bytes);
}

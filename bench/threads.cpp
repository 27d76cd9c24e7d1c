// What two threads are worth: alone on the machine, and beside two endless loops per processor. The flow of
// cases/demo.toml with both engines, and loops of a few microseconds. One and two threads in turn, medians; appends to
// performance-threads.csv.
//
//   bench_threads [quiet | busy]   one of both only
//
// The fair share: a scheduler that treats all alike gives n threads beside m loops on c processors n c/(n + m) of them.
// Wall time is compared with the CPU time of one thread over that, for one thread and for two.
#include <fmt/core.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "app/dem_input.hpp"
#include "config/case.hpp"
#include "core/cpu_limit.hpp"
#include "core/parallel.hpp"
#include "core/version.hpp"

namespace {
using namespace bagnold;

struct Cost {
  double wall = 0, cpu = 0;  // s
};

double cpu() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  return static_cast<double>(use.ru_utime.tv_sec + use.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(use.ru_utime.tv_usec + use.ru_stime.tv_usec);
}
double wall() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Endless loops, two for every processor this process may use.
class BusyMachine {
 public:
  BusyMachine() {
    for (int k = 0; k < 2 * cpu_limit(); ++k) {
      const pid_t child = fork();
      if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        for (std::atomic<int> turns{0};;) ++turns;
      }
      loops_.push_back(child);
    }
    usleep(200'000);  // until they are where they stay
  }
  BusyMachine(const BusyMachine&) = delete;
  ~BusyMachine() {
    for (const pid_t loop : loops_) kill(loop, SIGKILL), waitpid(loop, nullptr, 0);
  }
  double loops() const { return static_cast<double>(loops_.size()); }

 private:
  std::vector<pid_t> loops_;
};

// One and two threads in turn; make() returns what is to be timed.
std::array<Cost, 2> one_and_two(int rounds, const std::function<std::function<void()>()>& make) {
  std::array<std::vector<double>, 2> walls, cpus;
  for (int round = 0; round < rounds; ++round)
    for (const std::size_t k : {0, 1}) {
      set_threads(static_cast<int>(k) + 1);
      const auto work = make();
      const double from = wall(), before = cpu();
      work();
      walls[k].push_back(wall() - from);
      cpus[k].push_back(cpu() - before);
    }
  return {Cost{median(walls[0]), median(cpus[0])}, Cost{median(walls[1]), median(cpus[1])}};
}

std::ofstream& table() {
  static std::ofstream csv("performance-threads.csv", std::ios::app);
  if (csv.tellp() == 0) csv << "commit,what,machine,wall_1,cpu_1,wall_2,cpu_2\n";
  return csv;
}

void record(const std::string& what, const std::string& machine, const std::array<Cost, 2>& c) {
  table() << fmt::format("{},{},{},{:.4g},{:.4g},{:.4g},{:.4g}\n", git_hash(), what, machine, c[0].wall, c[0].cpu,
                         c[1].wall, c[1].cpu);
}

void compare_alone(const std::string& what, const std::function<std::function<void()>()>& make) {
  const auto quiet = one_and_two(7, make);
  fmt::print("{}, nothing else running: two threads {:.2f} times as fast as one, at {:.2f} times the CPU time\n", what,
             quiet[0].wall / quiet[1].wall, quiet[1].cpu / quiet[0].cpu);
  record(what, "quiet", quiet);
}

void compare_in_company(const std::string& what, const std::function<std::function<void()>()>& make) {
  const BusyMachine others;
  const auto busy = one_and_two(7, make);
  const double processors = cpu_limit(), loops = others.loops();
  const auto over_fair = [&](double wall_time, double n) {  // for n threads
    return wall_time / (busy[0].cpu / std::min(n, processors * n / (n + loops)));
  };
  fmt::print(
      "{}, beside {} endless loops: two threads take {:.2f} times the wall time of one, {:.2f} times its CPU time; "
      "over "
      "the "
      "fair share of one thread: one takes {:.2f}, two {:.2f}; over the fair share of two: two take {:.2f}\n",
      what, loops, busy[1].wall / busy[0].wall, busy[1].cpu / busy[0].cpu, over_fair(busy[0].wall, 1),
      over_fair(busy[1].wall, 1), over_fair(busy[1].wall, 2));
  record(what, "busy", busy);
}

// Microseconds a loop over two items of `work` microseconds takes.
void small_loops() {
  volatile double sink = 0;
  const auto spend = [&](std::int64_t turns) {
    double x = 1;
    for (std::int64_t k = 0; k < turns; ++k) x = x * 0.999999 + 1e-9;
    sink = x;
  };
  const double before = cpu();
  spend(50'000'000);
  const double turn_us = (cpu() - before) / 50;
  fmt::print("loops of two items, microseconds a loop:\n");
  for (const double work : {0.5, 1.0, 2.0, 4.0, 8.0, 32.0, 128.0}) {
    const auto loops = static_cast<int>(1e5 / work);
    const auto cost = one_and_two(5, [&] {
      return [&] {
        for (int k = 0; k < loops; ++k)
          parallel_for(2, [&](std::int64_t) { spend(static_cast<std::int64_t>(work / turn_us)); });
      };
    });
    fmt::print("  work {:6.1f}: one thread {:6.2f}, two threads {:6.2f}\n", 2 * work, 1e6 * cost[0].wall / loops,
               1e6 * cost[1].wall / loops);
    record(fmt::format("loop of {} us", 2 * work), "quiet", cost);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string only = argc > 1 ? argv[1] : "";
  set_threads(2);
  if (threads() < 2) return fmt::print("one processor only: nothing to compare\n"), 0;
  if (only != "busy") small_loops();
  config::Case input = config::Case::from_file(BAGNOLD_CASES "/demo.toml");
  const app::DemInput demo = app::build_dem(app::read_dem(input));
  dem::DemState flow = demo.state;
  advance(flow, demo.laws, 30'000);  // it flows
  fmt::print("the flow of cases/demo.toml, {} grains:\n", flow.grains.flowing);
  const auto fast = [&] { return [&, s = flow]() mutable { advance(s, demo.laws, 50'000); }; };
  const auto plain = [&] { return [&, s = flow]() mutable { advance_plain(s, demo.laws, 4'000); }; };
  if (only != "busy") compare_alone("fast engine", fast), compare_alone("plain engine", plain);
  if (only != "quiet") compare_in_company("fast engine", fast), compare_in_company("plain engine", plain);
  return 0;
}

// The size of the team on machines that are thought up: speed(seats) and the part of the time spent waiting.
#include "core/tempo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace bagnold {
namespace {

struct Machine {
  std::function<double(int)> speed;   // work per time by so many threads
  std::function<double(int)> waited;  // part of the time
};

// Sizes used in loops of 0.1 ms of work.
std::vector<int> sizes(Tempo& tempo, const Machine& machine, int wished, int loops) {
  std::vector<int> used;
  for (int k = 0; k < loops; ++k) {
    used.push_back(seats_now(tempo, wished));
    const double time = 1e5 / machine.speed(used.back());
    record(tempo, wished, 1e5, time, machine.waited(used.back()) * time);
  }
  return used;
}

double part(const std::vector<int>& used, int seats, std::size_t from = 0) {
  return static_cast<double>(std::count(used.begin() + static_cast<std::ptrdiff_t>(from), used.end(), seats)) /
         static_cast<double>(used.size() - from);
}

const Machine quiet{[](int n) { return 0.9 * n; }, [](int) { return 0.01; }};
// Threads that the system puts aside hold up the others.
const Machine busy{[](int n) { return n == 1 ? 0.4 : 0.1; }, [](int n) { return n == 1 ? 0.0 : 0.8; }};

TEST(Tempo, NothingIsTriedOnAQuietMachine) {
  Tempo tempo;
  EXPECT_EQ(part(sizes(tempo, quiet, 8, 20'000), 8), 1);
}

TEST(Tempo, ABusyMachineGetsOneThreadAndAQuietOneAllOfThemAgain) {
  Tempo tempo;
  auto used = sizes(tempo, busy, 2, 50'000);
  EXPECT_GT(part(used, 1), 0.9);
  EXPECT_GT(part(used, 1, 20'000), 0.98);  // tried more and more seldom
  EXPECT_LT(part(used, 1, 20'000), 1);     // but tried
  used = sizes(tempo, quiet, 2, 50'000);
  EXPECT_GT(part(used, 2), 0.7);
  EXPECT_EQ(part(used, 2, 30'000), 1);
  used = sizes(tempo, busy, 2, 50'000);
  EXPECT_GT(part(used, 1, 20'000), 0.95);
}

TEST(Tempo, ATeamThatWaitsButIsFasterStays) {
  const Machine uneven{[](int n) { return n == 1 ? 1.0 : 1.6; }, [](int n) { return n == 1 ? 0.0 : 0.2; }};
  Tempo tempo;
  const auto used = sizes(tempo, uneven, 2, 50'000);
  EXPECT_GT(part(used, 2, 10'000), 0.96);
}

// Five of eight processors are free.
TEST(Tempo, FindsTheSizeThatIsFastest) {
  const Machine shared{[](int n) { return n <= 5 ? n : 1.5; }, [](int n) { return n <= 5 ? 0.0 : 0.5; }};
  Tempo tempo;
  const auto used = sizes(tempo, shared, 8, 100'000);
  EXPECT_GT(part(used, 4, 20'000), 0.95);
}

TEST(Tempo, NeverMoreThanALoopIsWorth) {
  Tempo tempo;
  sizes(tempo, quiet, 8, 1000);
  EXPECT_EQ(seats_now(tempo, 3), 3);
  sizes(tempo, busy, 2, 10'000);
  EXPECT_EQ(seats_now(tempo, 1), 1);
}

}  // namespace
}  // namespace bagnold

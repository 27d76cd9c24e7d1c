// The size of the team on machines that are thought up: speed(seats) and the part of the time spent waiting.
#include "core/tempo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace bagnold {
namespace {

using Speed = std::function<double(int)>;  // work per time by so many threads

// Sizes used in loops of 0.1 ms of work.
std::vector<int> sizes(Tempo& tempo, const Speed& speed, int wished, int loops) {
  std::vector<int> used;
  for (int k = 0; k < loops; ++k) {
    used.push_back(seats_now(tempo, wished));
    const double begin = tempo.last + 1e3;
    record(tempo, {wished, 1e5, true, begin, begin + 1e5 / speed(used.back())});
  }
  return used;
}

double part(const std::vector<int>& used, int seats, std::size_t from = 0) {
  return static_cast<double>(std::count(used.begin() + static_cast<std::ptrdiff_t>(from), used.end(), seats)) /
         static_cast<double>(used.size() - from);
}

double quiet(int n) { return 0.9 * n + 0.1; }
// Threads that the system puts aside hold up the others.
double busy(int n) { return n == 1 ? 0.4 : 0.1; }

TEST(Tempo, AQuietMachineIsUsed) {
  Tempo tempo;
  const auto used = sizes(tempo, quiet, 2, 100'000);
  EXPECT_EQ(used[0], 2);
  EXPECT_GT(part(used, 2), 0.97);
  EXPECT_GT(part(used, 2, 30'000), 0.98);  // tried more and more seldom
  EXPECT_LT(part(used, 2, 30'000), 1);     // but tried
}

TEST(Tempo, ABusyMachineGetsOneThreadAndAQuietOneAllOfThemAgain) {
  Tempo tempo;
  auto used = sizes(tempo, busy, 2, 50'000);
  EXPECT_GT(part(used, 1), 0.9);
  EXPECT_GT(part(used, 1, 20'000), 0.98);
  EXPECT_LT(part(used, 1, 20'000), 1);
  used = sizes(tempo, quiet, 2, 100'000);
  EXPECT_GT(part(used, 2), 0.7);
  EXPECT_GT(part(used, 2, 50'000), 0.97);
  used = sizes(tempo, busy, 2, 100'000);
  EXPECT_GT(part(used, 1, 50'000), 0.95);
}

TEST(Tempo, TwiceTheThreadsHaveToBeAFifthFaster) {
  for (const auto& [speed_of_two, best] : {std::pair{1.15, 1}, {1.25, 2}}) {
    Tempo tempo;
    const auto used = sizes(
        tempo, [&](int n) { return n == 1 ? 1.0 : speed_of_two; }, 2, 50'000);
    EXPECT_GT(part(used, best, 10'000), 0.96) << speed_of_two;
  }
}

TEST(Tempo, AnotherKindOfLoopIsTriedAtOnce) {
  Tempo tempo;
  sizes(tempo, quiet, 2, 200'000);  // others are tried seldom by now
  int loops = 0;
  for (bool known = false; seats_now(tempo, 2) == 2 && loops < 10'000; ++loops) {
    record(tempo, {2, 1e5, known, tempo.last, tempo.last + 1e5});
    known = seats_now(tempo, 2) == 1;
  }
  EXPECT_LE(loops, 2 * Tempo::window_ns / 1e5);
}

TEST(Tempo, FindsTheSizeThatIsFastest) {
  for (const int best : {1, 2, 4, 8}) {
    Tempo tempo;
    const auto speed = [&](int n) { return n <= best ? n : 0.5 * best; };
    EXPECT_GT(part(sizes(tempo, speed, 8, 200'000), best, 50'000), 0.9) << best;
  }
}

TEST(Tempo, NeverMoreThanALoopIsWorth) {
  Tempo tempo;
  EXPECT_EQ(seats_now(tempo, 3), 3);
  sizes(tempo, quiet, 8, 1000);
  for (int k = 0; k < 10'000; ++k) {
    const int wished = 1 + k % 8;
    EXPECT_TRUE(seats_now(tempo, wished) >= 1 && seats_now(tempo, wished) <= wished);
    record(tempo, {wished, 1e5, true, tempo.last, tempo.last + 1e5});
  }
}

}  // namespace
}  // namespace bagnold

// The team of threads: every item once, the same bits, exceptions, nesting, signals, forks, and rest without work.
#include "core/parallel.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>

namespace bagnold {
namespace {

using namespace std::chrono_literals;

// More threads than this machine may have are the hardest case there is.
class Parallel : public testing::TestWithParam<int> {
 protected:
  Parallel() { force_threads(GetParam()); }
  ~Parallel() override { set_threads(0); }
};
INSTANTIATE_TEST_SUITE_P(Threads, Parallel, testing::Values(1, 2, 3, 4, 5, 6, 7, 8));

double process_seconds() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  return static_cast<double>(use.ru_utime.tv_sec + use.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(use.ru_utime.tv_usec + use.ru_stime.tv_usec);
}

// Keeps every thread of the team busy long enough for all of them to come.
void work(std::chrono::microseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (std::chrono::steady_clock::now() < end) continue;
}

TEST_P(Parallel, EveryItemOnce) {
  for (const std::int64_t n : {0, 1, 2, 3, 7, 64, 1000, 4099, 100'000}) {
    std::vector<int> visits(static_cast<std::size_t>(n));
    for (int round = 0; round < 30; ++round) {
      parallel_for(n, [&](std::int64_t i) { ++visits[static_cast<std::size_t>(i)]; });
      parallel_for(
          n, [&](std::int64_t i) { ++visits[static_cast<std::size_t>(i)]; }, false);
      parallel_blocks(n, 64, [&](std::int64_t begin, std::int64_t end) {
        EXPECT_EQ(begin % 64, 0);
        EXPECT_TRUE(end == n || end == begin + 64);
        for (std::int64_t i = begin; i < end; ++i) ++visits[static_cast<std::size_t>(i)];
      });
    }
    EXPECT_EQ(visits, std::vector<int>(visits.size(), 90)) << n;
  }
}

TEST_P(Parallel, SumsHaveTheSameBitsOnAnyNumberOfThreads) {
  constexpr std::int64_t n = 12'345;  // not a multiple of the block
  const auto sum = [] {
    return parallel_sum<double>(n, [](std::int64_t i) {
      return std::sin(static_cast<double>(i)) * 1e8 + 1.0 / (1.0 + static_cast<double>(i));
    });
  };
  for (int round = 0; round < 20; ++round) {
    force_threads(1);
    const double alone = sum();
    force_threads(GetParam());
    EXPECT_EQ(std::bit_cast<std::uint64_t>(sum()), std::bit_cast<std::uint64_t>(alone));
  }
}

TEST_P(Parallel, AllIsTrueOnlyIfEveryItemHoldsAndAsksAllOfThem) {
  constexpr std::int64_t n = 5000;
  for (const std::int64_t bad : {std::int64_t{-1}, std::int64_t{0}, std::int64_t{2500}, n - 1})
    for (const bool worthwhile : {true, false}) {
      std::vector<int> asked(n);
      EXPECT_EQ(parallel_all(
                    n, [&](std::int64_t i) { return ++asked[static_cast<std::size_t>(i)], i != bad; }, worthwhile),
                bad < 0);
      EXPECT_EQ(asked, std::vector<int>(n, 1));
    }
}

TEST_P(Parallel, IndicesTellThreadsApart) {
  const auto many = static_cast<std::size_t>(GetParam());
  EXPECT_EQ(threads(), GetParam());
  EXPECT_EQ(thread_index(), 0);
  std::vector<std::set<std::thread::id>> who(many);
  std::vector<std::atomic<int>> there(many);
  PerThread memory;
  memory.prepare();
  for (int round = 0; round < 50; ++round)
    parallel_for(64, [&](std::int64_t) {
      const auto me = static_cast<std::size_t>(thread_index());
      ASSERT_LT(me, many);
      EXPECT_EQ(there[me].fetch_add(1), 0);  // nobody else has this index now
      who[me].insert(std::this_thread::get_id());
      ++memory.mine<int>();
      work(20us);
      there[me].fetch_sub(1);
    });
  int all = 0;
  for (const auto& ids : who) EXPECT_LE(ids.size(), 1U);
  EXPECT_EQ(who[0], std::set{std::this_thread::get_id()});  // the caller takes part
  parallel_for(1, [&](std::int64_t) { all = memory.mine<int>(); });
  EXPECT_GT(all, 0);
  PerThread copy = memory;
  copy.prepare();
  EXPECT_EQ(copy.mine<int>(), 0);
}

TEST_P(Parallel, AllThreadsCome) {
  std::vector<std::atomic<int>> items(static_cast<std::size_t>(GetParam()));
  const auto came = [](const std::atomic<int>& count) { return count > 0; };
  const auto end = std::chrono::steady_clock::now() + 20s;  // a busy machine gives them time late
  int loops = 0;
  while (!std::all_of(items.begin(), items.end(), came) && std::chrono::steady_clock::now() < end) {
    parallel_for(200, [&](std::int64_t i) {
      work(i < 20 ? 1ms : 20us);  // uneven
      ++items[static_cast<std::size_t>(thread_index())];
    });
    ++loops;
  }
  EXPECT_TRUE(std::all_of(items.begin(), items.end(), came));
  int all = 0;
  for (const auto& count : items) all += count;
  EXPECT_EQ(all, 200 * loops);
}

TEST_P(Parallel, LoopsWithinItemsStayOnTheirThread) {
  std::vector<int> visits(40 * 500);
  for (int round = 0; round < 10; ++round)
    parallel_for(40, [&](std::int64_t i) {
      const int outer = thread_index();
      const auto id = std::this_thread::get_id();
      parallel_for(500, [&](std::int64_t k) {
        EXPECT_TRUE(thread_index() == outer && std::this_thread::get_id() == id);
        ++visits[static_cast<std::size_t>(500 * i + k)];
      });
    });
  EXPECT_EQ(visits, std::vector<int>(visits.size(), 10));
}

TEST_P(Parallel, LoopsStayWithWhoWantsToBeAlone) {
  const auto stays = [] {
    std::atomic<bool> all{true};
    const auto id = std::this_thread::get_id();
    parallel_for(64, [&](std::int64_t) {
      work(20us);
      if (std::this_thread::get_id() != id) all = false;
    });
    return all.load();
  };
  {
    const Alone alone;
    const Alone not_meant(false);
    for (int round = 0; round < 20; ++round) EXPECT_TRUE(stays());
  }
  if (GetParam() == 1) return;
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (stays() && std::chrono::steady_clock::now() < end) continue;
  EXPECT_LT(std::chrono::steady_clock::now(), end);  // others come again
}

TEST_P(Parallel, TheFirstExceptionReachesTheCaller) {
  for (int round = 0; round < 30; ++round) {
    try {
      parallel_for(1000, [&](std::int64_t i) {
        if (i % 100 == 37 && i > 200) throw std::runtime_error(std::to_string(i));
      });
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& e) {
      EXPECT_STREQ(e.what(), "237");
    }
    std::atomic<int> after{0};
    parallel_for(100, [&](std::int64_t) { ++after; });  // the team is as good as before
    EXPECT_EQ(after, 100);
  }
}

TEST_P(Parallel, LoopsOfSeveralThreadsDoNotMix) {
  std::vector<std::vector<int>> visits(4, std::vector<int>(3000));
  std::vector<std::thread> callers;
  for (auto& mine : visits)
    callers.emplace_back([&mine] {
      for (int round = 0; round < 50; ++round)
        parallel_for(3000, [&](std::int64_t i) { ++mine[static_cast<std::size_t>(i)]; });
    });
  for (std::thread& caller : callers) caller.join();
  for (const auto& mine : visits) EXPECT_EQ(mine, std::vector<int>(3000, 50));
}

TEST_P(Parallel, SignalsAreLeftToTheCaller) {
  std::atomic<int> open{0};
  const auto caller = std::this_thread::get_id();
  parallel_for(64, [&](std::int64_t) {
    work(200us);
    if (std::this_thread::get_id() == caller) return;
    sigset_t blocked;
    pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
    open += sigismember(&blocked, SIGINT) == 0 || sigismember(&blocked, SIGTERM) == 0;
  });
  EXPECT_EQ(open, 0);
  sigset_t mine;
  pthread_sigmask(SIG_SETMASK, nullptr, &mine);
  EXPECT_EQ(sigismember(&mine, SIGINT), 0);
}

TEST_P(Parallel, WorksInAForkedProcess) {
#if defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the thread sanitizer allows no threads after a fork";
#endif
  parallel_for(1000, [](std::int64_t) {});
  const pid_t child = fork();
  if (child == 0) {
    alarm(20);
    std::atomic<int> items{0};
    parallel_for(1000, [&](std::int64_t) { ++items; });
    _exit(items == 1000 ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

// Eight threads and every loop small: nobody waits for a thread that does not come.
TEST_P(Parallel, SmallLoopsFinishHoweverManyThreadsThereAre) {
  std::vector<double> x(500, 1.0);
  const double before = process_seconds();
  for (int round = 0; round < 2000; ++round)
    parallel_for(500, [&](std::int64_t i) { x[static_cast<std::size_t>(i)] *= 1.0001; });
  EXPECT_EQ(std::count(x.begin(), x.end(), x[0]), 500);
  EXPECT_LT(process_seconds() - before, 10);
}

TEST_P(Parallel, ATeamWithoutWorkSleeps) {
  parallel_for(1000, [&](std::int64_t) { work(10us); });
  std::this_thread::sleep_for(20ms);  // longer than anybody looks for work
  const double before = process_seconds();
  std::this_thread::sleep_for(300ms);
  EXPECT_LT(process_seconds() - before, 0.02);
}

TEST(Threads, WishesAreBoundedByWhatIsAllowed) {
  unsetenv("SLURM_CPUS_PER_TASK");
  unsetenv("OMP_NUM_THREADS");
  EXPECT_EQ(set_threads(0), "");
  const int allowed = threads();
  ASSERT_GE(allowed, 1);
  const std::string many = std::to_string(allowed + 5);
  const auto note = [&](const std::string& who) {
    return who + " asks for " + many + " threads; the processors and the quota of this process allow " +
           std::to_string(allowed);
  };
  EXPECT_EQ(set_threads(allowed + 5), note("--threads"));
  EXPECT_EQ(threads(), allowed);

  setenv("SLURM_CPUS_PER_TASK", "1", 1);
  EXPECT_EQ(set_threads(0), "");
  EXPECT_EQ(threads(), 1);
  setenv("OMP_NUM_THREADS", (many + ",2").c_str(), 1);  // goes before; only the outermost level counts
  EXPECT_EQ(set_threads(0), note("OMP_NUM_THREADS"));
  EXPECT_EQ(threads(), allowed);
  EXPECT_EQ(set_threads(1), "");  // and the option before both
  EXPECT_EQ(threads(), 1);
  setenv("OMP_NUM_THREADS", "none", 1);
  EXPECT_EQ(set_threads(0), "");
  EXPECT_EQ(threads(), 1);  // SLURM_CPUS_PER_TASK again
  setenv("SLURM_CPUS_PER_TASK", many.c_str(), 1);
  EXPECT_EQ(set_threads(0), note("SLURM_CPUS_PER_TASK"));
  unsetenv("SLURM_CPUS_PER_TASK");
  unsetenv("OMP_NUM_THREADS");
  set_threads(0);
}

}  // namespace
}  // namespace bagnold

#include "engine/sph/threads/thread_team.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <new>
#include <numeric>
#include <system_error>
#include <thread>
#include <vector>

#include "tests/sph/threads/few_threads.hpp"

namespace sluice {
namespace {

TEST(ThreadTeam, CallsEveryTaskExactlyOnce) {
  for (const int threads : {1, 2, 3, 5, 8}) {
    ThreadTeam team(threads);
    ASSERT_EQ(team.size(), threads);
    for (const std::size_t tasks : {0, 1, 2, 3, 4, 7, 8, 9, 63, 64, 65, 1000, 4099}) {
      // Not atomic: a task called twice at once is a race that the thread sanitizer sees.
      std::vector<int> calls(tasks, 0);
      team.run(tasks, [&](std::size_t task) { ++calls[task]; });
      for (std::size_t task = 0; task < tasks; ++task) {
        ASSERT_EQ(calls[task], 1) << threads << " threads, task " << task << " of " << tasks;
      }
    }
  }
}

TEST(ThreadTeam, CallsBothOfEveryTaskExactlyOnceAndNoSecondBeforeTheFirstsItNeeds) {
  for (const int threads : {1, 2, 3, 5, 8}) {
    ThreadTeam team(threads);
    for (const std::size_t tasks : {0, 1, 2, 3, 4, 7, 16, 65, 1000, 3}) {
      for (const std::size_t reach : {0, 1, 3}) {
        // Not atomic: what is read too early is a race that the thread sanitizer sees.
        std::vector<int> firsts(tasks, 0);
        std::vector<int> seconds(tasks, 0);
        std::vector<std::size_t> found(tasks, 0);
        const auto needs = [&](std::size_t task) {
          std::vector<std::uint32_t> earlier;
          for (std::size_t back = 1; back <= std::min(reach, task); ++back) {
            earlier.push_back(static_cast<std::uint32_t>(task - back));
          }
          return earlier;
        };
        team.run_both(
            tasks,
            [&](std::size_t task) {
              if (task % 7 == 3) std::this_thread::sleep_for(std::chrono::microseconds(50));
              ++firsts[task];
            },
            needs,
            [&](std::size_t task) {
              for (const std::uint32_t other : needs(task)) {
                found[task] += static_cast<std::size_t>(firsts[other]);
              }
              ++seconds[task];
            });
        for (std::size_t task = 0; task < tasks; ++task) {
          ASSERT_EQ(firsts[task], 1) << threads << " threads, task " << task << " of " << tasks;
          ASSERT_EQ(seconds[task], 1) << threads << " threads, task " << task << " of " << tasks;
          ASSERT_EQ(found[task], std::min(reach, task));
        }
      }
    }
  }
}

TEST(ThreadTeam, ThrowsWhatATaskThrewAfterTheOthersAndGoesOnWorking) {
  for (const int threads : {2, 3, 8}) {
    ThreadTeam team(threads);
    constexpr std::size_t kTasks = 100;
    std::vector<int> calls(kTasks, 0);
    const auto fails = [&](std::size_t task) {
      ++calls[task];
      if (task == 41) throw std::bad_alloc();
    };
    const auto needs = [](std::size_t) { return std::vector<std::size_t>{41}; };
    const auto nothing = [](std::size_t) {};
    EXPECT_THROW(team.run(kTasks, fails), std::bad_alloc);
    EXPECT_EQ(calls, std::vector<int>(kTasks, 1));
    EXPECT_THROW(team.run_both(kTasks, fails, needs, nothing), std::bad_alloc);
    EXPECT_EQ(calls, std::vector<int>(kTasks, 2));
    EXPECT_NO_THROW(team.run(kTasks, nothing));
  }
}

TEST(ThreadTeam, TakesZeroAndFewerThreadsForOne) {
  for (const int threads : {0, -1, -100}) {
    ThreadTeam team(threads);
    EXPECT_EQ(team.size(), 1);
    int calls = 0;
    team.run(5, [&](std::size_t) { ++calls; });
    EXPECT_EQ(calls, 5);
  }
}

TEST(ThreadTeam, EachRunSeesAllThatTheRunBeforeWrote) {
  ThreadTeam team(3);
  constexpr std::size_t kTasks = 40;
  constexpr long kRuns = 10000;
  std::vector<long> value(kTasks);
  std::iota(value.begin(), value.end(), 0L);
  std::vector<long> next(kTasks);
  for (long run = 0; run < kRuns; ++run) {
    // Each task reads what another thread may have written in the last run.
    team.run(kTasks, [&](std::size_t task) { next[task] = value[(task + 13) % kTasks] + 1; });
    value.swap(next);
  }
  for (std::size_t task = 0; task < kTasks; ++task) {
    const std::size_t origin = (task + 13 * static_cast<std::size_t>(kRuns)) % kTasks;
    ASSERT_EQ(value[task], kRuns + static_cast<long>(origin));
  }
}

TEST(ThreadTeam, UnequalTasksAreAllDoneWhenRunReturns) {
  ThreadTeam team(4);
  for (int run = 0; run < 30; ++run) {
    std::vector<int> done(16, 0);
    team.run(done.size(), [&](std::size_t task) {
      if (task % 5 == 0) std::this_thread::sleep_for(std::chrono::microseconds(300));
      done[task] = 1;
    });
    ASSERT_EQ(std::accumulate(done.begin(), done.end(), 0), 16);
  }
}

TEST(ThreadTeam, EndsWhetherItsHelpersSpinSleepOrNeverWorked) {
  for (int round = 0; round < 100; ++round) {
    ThreadTeam team(1 + round % 5);
    if (round % 3 != 0) team.run(10, [](std::size_t) {});
    if (round % 10 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

TEST(ThreadTeam, WakesAfterItsHelpersFellAsleep) {
  ThreadTeam team(3);
  for (int round = 0; round < 10; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    std::vector<int> calls(100, 0);
    team.run(calls.size(), [&](std::size_t task) { ++calls[task]; });
    ASSERT_EQ(std::accumulate(calls.begin(), calls.end(), 0), 100);
  }
}

TEST(ThreadTeam, TwoTeamsWorkSideBySide) {
  const auto sum_of_squares = [] {
    ThreadTeam team(2);
    std::vector<long> square(500);
    long total = 0;
    for (int run = 0; run < 200; ++run) {
      team.run(square.size(), [&](std::size_t k) { square[k] = static_cast<long>(k * k); });
      total += std::accumulate(square.begin(), square.end(), 0L);
    }
    return total;
  };
  long other = 0;
  std::thread beside([&] { other = sum_of_squares(); });
  const long own = sum_of_squares();
  beside.join();
  // 200 sum_{k<500} k^2 = 200 * 499 * 500 * 999/6
  EXPECT_EQ(own, 200L * 499 * 500 * 999 / 6);
  EXPECT_EQ(other, own);
}

TEST(ThreadTeam, SaysSoWhenTheSystemRefusesAThreadAndEndsThoseThatRun) {
  if (!test::kThreadsCanBeRefused) GTEST_SKIP() << "sanitizers need the addresses themselves";
  const test::FewThreads few;
  EXPECT_THROW(ThreadTeam(200), std::system_error);
}

}  // namespace
}  // namespace sluice

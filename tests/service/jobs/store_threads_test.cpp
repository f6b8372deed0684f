#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/service/jobs/store_support.hpp"

namespace sluice::test {
namespace {

/// Runs `action(i)` in `count` threads that set off together.
void together(int count, const std::function<void(int)>& action) {
  std::atomic<int> waiting = count;
  std::vector<std::thread> threads;
  for (int i = 0; i < count; ++i) {
    threads.emplace_back([&, i] {
      --waiting;
      while (waiting > 0) std::this_thread::yield();
      action(i);
    });
  }
  for (std::thread& thread : threads) thread.join();
}

TEST(StoreThreads, SubmittingWithOneKeyAtOnceMakeOneJob) {
  const DataFolder data;
  JobStore store(data.path());
  constexpr int kThreads = 100;
  std::vector<JobStore::Submitted> results(kThreads);
  together(kThreads, [&](int i) {
    Job job = a_job();
    job.id = store.new_id();
    results[static_cast<std::size_t>(i)] = store.submit(job, "key", "hash", 10);
  });
  EXPECT_EQ(store.list({}).size(), 1U);
  int made = 0;
  for (const JobStore::Submitted& result : results) {
    EXPECT_EQ(result.job.id, results.front().job.id);
    made += result.repeated ? 0 : 1;
  }
  EXPECT_EQ(made, 1);
}

TEST(StoreThreads, ClaimingAtOnceNeverGetTheSameJob) {
  const DataFolder data;
  JobStore store(data.path());
  constexpr int kJobs = 40;
  for (int i = 0; i < kJobs; ++i) (void)add_job(store, i % 3);
  std::vector<std::vector<std::string>> claimed(4);
  together(4, [&](int i) {
    while (const std::optional<Job> job = store.claim(1, {})) {
      claimed[static_cast<std::size_t>(i)].push_back(job->id);
    }
  });
  std::set<std::string> all;
  std::size_t count = 0;
  for (const auto& ids : claimed) {
    all.insert(ids.begin(), ids.end());
    count += ids.size();
  }
  EXPECT_EQ(count, static_cast<std::size_t>(kJobs));
  EXPECT_EQ(all.size(), static_cast<std::size_t>(kJobs));
}

TEST(StoreThreads, EndingOneAttemptAtOnceEndItOnce) {
  const DataFolder data;
  JobStore store(data.path());
  const Job job = add_job_in(store, JobState::running);
  std::atomic<int> ended = 0;
  together(8, [&](int i) {
    try {
      (void)store.apply(job.id, i % 2 == 0 ? JobAction::complete : JobAction::requeue, job.token,
                        {});
      ++ended;
    } catch (const JobStoreError& error) {
      EXPECT_EQ(error.fault(), JobStoreError::Fault::conflict);
    }
  });
  EXPECT_EQ(ended, 1);
  EXPECT_EQ(store.last_event(), 3);
}

TEST(StoreThreads, ReadingWhileOthersWriteSeeWholeJobs) {
  const DataFolder data;
  JobStore store(data.path());
  std::atomic<bool> stop = false;
  std::thread writer([&] {
    for (int i = 0; i < 30; ++i) {
      const Job job = add_job_in(store, JobState::running);
      store.record_progress(job.id, job.token, "{}");
      (void)store.apply(job.id, JobAction::complete, job.token, {});
    }
    stop = true;
  });
  while (!stop) {
    for (const Job& job : store.list({})) {
      EXPECT_EQ(job.token.empty(), job.state != JobState::running);
      EXPECT_EQ(job.ended_ms != 0, is_ended(job.state));
    }
    (void)store.count_by_state();
    (void)store.events("", store.last_event() - 1, 5);
  }
  writer.join();
}

}  // namespace
}  // namespace sluice::test

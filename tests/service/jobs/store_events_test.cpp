#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "tests/service/jobs/store_support.hpp"

namespace sluice::test {
namespace {

/// Longer than any test lasts: a wait that is not ended by what the test does shows as a hang.
constexpr double kForever = 1000.0;  // s

TEST(Events, AreNumberedOverAllJobsInTheirOrder) {
  const DataFolder data;
  JobStore store(data.path());
  EXPECT_EQ(store.last_event(), 0);
  const std::string a = add_job(store).id;
  const std::string b = add_job(store).id;
  store.record_event(a, "checkpoint", R"({"step":5})");
  store.record_event(b, "checkpoint", "{}");
  const std::vector<JobEvent> all = store.events("", 0, 100);
  ASSERT_EQ(all.size(), 4U);
  const std::vector<std::string> jobs = {a, b, a, b};
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].number, static_cast<std::int64_t>(i + 1));
    EXPECT_EQ(all[i].job, jobs[i]);
    EXPECT_GE(all[i].time_ms, all[i == 0 ? 0 : i - 1].time_ms);
  }
  EXPECT_EQ(all[2].name, "checkpoint");
  EXPECT_EQ(all[2].detail, R"({"step":5})");
  EXPECT_EQ(store.last_event(), 4);
}

TEST(Events, AreReplayedFromANumberInPages) {
  const DataFolder data;
  JobStore store(data.path());
  const std::string a = add_job(store).id;
  (void)add_job(store);
  for (int i = 0; i < 10; ++i) store.record_event(a, "checkpoint", std::to_string(i));
  const std::vector<JobEvent> page = store.events(a, 3, 4);
  ASSERT_EQ(page.size(), 4U);
  EXPECT_EQ(page.front().detail, "1");
  EXPECT_EQ(page.back().detail, "4");
  EXPECT_TRUE(store.events(a, 12, 4).empty());
  EXPECT_TRUE(store.events("nobody", 0, 4).empty());
}

TEST(Events, KeepTheirNumbersAfterARestartAndUseNoneTwice) {
  const DataFolder data;
  std::int64_t last = 0;
  {
    JobStore store(data.path());
    const Job job = add_job_in(store, JobState::cancelled);
    last = store.last_event();
    EXPECT_EQ(last, 2);
    store.remove(job.id);
    EXPECT_EQ(store.last_event(), last);
  }
  JobStore store(data.path());
  EXPECT_EQ(store.last_event(), last);
  (void)add_job(store);
  EXPECT_EQ(store.events("", 0, 10).front().number, last + 1);
}

TEST(Waiting, EndsAtOnceForWhatHappenedBefore) {
  const DataFolder data;
  JobStore store(data.path());
  const std::string id = add_job(store).id;
  store.wait_for_event(id, 0, kForever);
  store.wait_for_event("", 0, kForever);
  store.wait_for_event(store.new_id(), 0, kForever);  // no such job: there is nothing to wait for
}

TEST(Waiting, EndsWhenItsTimeIsOverHoweverOddThatTimeIs) {
  const DataFolder data;
  JobStore store(data.path());
  const std::string id = add_job(store).id;
  const auto start = std::chrono::steady_clock::now();
  store.wait_for_event(id, 1, 0.02);
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(20));
  store.wait_for_event(id, 1, 0.0);
  store.wait_for_event(id, 1, -1e308);
  store.wait_for_event(id, 1, std::numeric_limits<double>::quiet_NaN());
}

/// Waits in a thread of its own; `done` tells when it came back.
class Waiter {
 public:
  Waiter(const JobStore& store, std::string id, std::int64_t after)
      : thread_([this, &store, id = std::move(id), after] {
          store.wait_for_event(id, after, kForever);
          done_ = true;
        }) {}
  Waiter(const Waiter&) = delete;
  Waiter& operator=(const Waiter&) = delete;
  ~Waiter() { thread_.join(); }
  [[nodiscard]] bool done() const { return done_; }

 private:
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

TEST(WaitingThread, IsWokenByEventsOfItsJobAndOfNoOther) {
  const DataFolder data;
  JobStore store(data.path());
  const std::string mine = add_job(store).id;
  const std::string other = add_job(store).id;
  {
    const Waiter for_mine(store, mine, store.last_event());
    {
      const Waiter for_any(store, "", store.last_event());
      store.record_event(other, "checkpoint", "{}");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_FALSE(for_mine.done());
    (void)store.apply(mine, JobAction::pause, "", {});
  }
}

TEST(WaitingThread, IsWokenWhenItsJobIsRemoved) {
  const DataFolder data;
  JobStore store(data.path());
  const Job job = add_job_in(store, JobState::cancelled);
  const Waiter waiter(store, job.id, store.last_event());
  store.remove(job.id);
}

TEST(WaitingThread, IsWokenByAStopAfterWhichNobodyWaits) {
  const DataFolder data;
  JobStore store(data.path());
  const std::string id = add_job(store).id;
  std::vector<std::unique_ptr<Waiter>> waiters;
  for (int i = 0; i < 8; ++i) waiters.push_back(std::make_unique<Waiter>(store, id, 1));
  store.wake();
  waiters.clear();
  store.wait_for_event(id, 1, kForever);
}

}  // namespace
}  // namespace sluice::test

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "service/jobs/queue_view.hpp"
#include "tests/service/scheduler/scheduler_support.hpp"

namespace sluice::test {
namespace {

// Each run leaves "+ID" and "-ID" in DATA/order: when it began and when it ended.
constexpr std::string_view kNoteOrder =
    R"(order="$2/../../order"; id=$(basename "$PWD")
echo "+$id" >> "$order"; sleep 0.05; echo "-$id" >> "$order"
echo '{"state":"completed","exit_code":0,"reason":"","end_time":0.1}' > "$2/outcome.json")";

// Runs until it is told to stop.
constexpr std::string_view kEndless = R"(trap 'exit 85' TERM
echo '{"event":"started","step":0}'
while :; do sleep 0.02; done)";

class SchedulerQueueThread : public ::testing::Test {
 protected:
  void start(std::string_view script) {
    scheduler_.emplace(store_, data_.path(), limits_, write_worker(data_, script));
  }
  std::string why(const Job& job) { return scheduler_->why_waiting(*store_.find(job.id)); }
  /// Waits until the answer is this one.
  void expect_why(const Job& job, const std::string& text) {
    wait_until(text, [&] { return why(job) == text; });
  }

  DataFolder data_;
  JobStore store_{data_.path()};
  ServiceLimits limits_ = limits_for_scripts();
  std::optional<Scheduler> scheduler_;
};

TEST_F(SchedulerQueueThread, TakesHigherPriorityFirstThenAge) {
  limits_.cores = 1;
  const Job old = add_real_job(store_, data_, 0.1, 0);
  const Job young = add_real_job(store_, data_, 0.1, 0);
  const Job urgent = add_real_job(store_, data_, 0.1, 5);
  start(kNoteOrder);
  for (const Job& job : {old, young, urgent}) wait_for(store_, job.id, JobState::completed);
  std::string expected;
  for (const Job& job : {urgent, old, young}) expected += "+" + job.id + "\n-" + job.id + "\n";
  EXPECT_EQ(read_file(data_.path() / "order"), expected);
}

TEST_F(SchedulerQueueThread, NeverRunsMoreThreadsThanThereAreCores) {
  limits_.cores = 3;
  std::vector<Job> jobs;
  for (int i = 0; i < 12; ++i) jobs.push_back(add_real_job(store_, data_, 0.1, 0, 1 + i % 3));
  start(kNoteOrder);
  for (const Job& job : jobs) wait_for(store_, job.id, JobState::completed);
  std::map<std::string, int> threads;
  for (const Job& job : jobs) threads[job.id] = job.threads;
  int busy = 0;
  int most = 0;
  std::istringstream order(read_file(data_.path() / "order"));
  for (std::string line; std::getline(order, line);) {
    busy += (line[0] == '+' ? 1 : -1) * threads.at(line.substr(1));
    most = std::max(most, busy);
  }
  EXPECT_EQ(busy, 0);
  EXPECT_LE(most, 3);
}

TEST_F(SchedulerQueueThread, SaysWhyAJobWaits) {
  const Job running = add_real_job(store_, data_);
  start(kEndless);
  wait_for_event(store_, running.id, "started");
  EXPECT_EQ(why(running), "");
  const Job wide = add_real_job(store_, data_, 0.1, 0, 2);
  const Job second = add_real_job(store_, data_, 0.1, 0, 2);
  const Job third = add_real_job(store_, data_, 0.1, -1, 2);
  const Job giant = add_real_job(store_, data_, 0.1, 9, 99);
  expect_why(giant, "needs 99 threads, and this service has 2: it can never run here");
  store_.apply(giant.id, JobAction::cancel, "", {});
  expect_why(wide, "needs 2 threads, 1 of 2 is free");
  expect_why(second, "1 job with higher priority or age is ahead");
  expect_why(third, "2 jobs with higher priority or age are ahead");
}

TEST_F(SchedulerQueueThread, ThreadsThatPokeAndAskAtOnceDisturbNothing) {
  std::vector<Job> jobs;
  for (int i = 0; i < 6; ++i) jobs.push_back(add_real_job(store_, data_));
  start(kNoteOrder);
  std::vector<std::thread> askers;
  std::atomic<bool> done = false;
  for (int i = 0; i < 4; ++i) {
    askers.emplace_back([&] {
      while (!done) {
        scheduler_->poke();
        for (const Job& job : jobs) {
          (void)why(job);
          (void)scheduler_->checkpoint_now(job.id);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    });
  }
  for (const Job& job : jobs) wait_for(store_, job.id, JobState::completed);
  std::thread drainer([&] { scheduler_->drain(); });
  scheduler_->drain();
  drainer.join();
  done = true;
  for (std::thread& asker : askers) asker.join();
}

TEST(QueueView, KnowsTheOrderOfClaims) {
  const DataFolder data;
  JobStore store(data.path());
  const QueueView view(store);
  const Job a = add_job(store, 0, 4);
  const Job b = add_job(store, 3, 2);
  const Job c = add_job(store, 0, 1);
  EXPECT_EQ(view.ahead_of(b, 0.0), 0U);
  EXPECT_EQ(view.ahead_of(a, 0.0), 1U);
  EXPECT_EQ(view.ahead_of(c, 0.0), 2U);
  EXPECT_EQ(view.first(8, {}, 0.0)->id, b.id);
  EXPECT_EQ(view.first(8, {b.id}, 0.0)->id, a.id);
  EXPECT_EQ(view.first(1, {b.id}, 0.0)->id, c.id);
  EXPECT_FALSE(view.first(0, {}, 0.0));
  store.apply(b.id, JobAction::cancel, "", {});
  EXPECT_EQ(view.ahead_of(a, 0.5), 1U) << "still what it was a moment ago";
  EXPECT_EQ(view.ahead_of(a, 1.5), 0U);
}

}  // namespace
}  // namespace sluice::test

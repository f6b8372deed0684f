#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <optional>
#include <string>

#include "service/scheduler/patience.hpp"
#include "tests/service/scheduler/mock_executor.hpp"
#include "tests/service/scheduler/scheduler_support.hpp"

namespace sluice::test {
namespace {

/// Works until it is told to stop or released; answers SIGUSR1 with the event "checkpoint".
MockHabits until_released() {
  MockHabits habits;
  habits.begins = [](MockWorker& worker) {
    worker.say(R"({"event":"started","step":0})");
    worker.say(R"({"event":"progress","step":5})");
  };
  habits.hears = [](MockWorker& worker, int signal) {
    if (signal != SIGUSR1) return worker.exit(85);
    worker.say(R"({"event":"checkpoint","step":5})");
  };
  return habits;
}

/// A machine whose time, cores and disk are what the test says.
class SchedulerSensesThread : public ::testing::Test {
 protected:
  void start() {
    SchedulerSenses senses;
    senses.clock = [this] { return time_.load(); };
    senses.free_disk = [this](const std::filesystem::path&) { return free_.load(); };
    senses.core_use = [this](pid_t) { return CoreUse{core_seconds_.load(), runnable_.load()}; };
    workers_.set_habits(until_released());
    scheduler_.emplace(store_, data_.path(), limits_, std::filesystem::path(), senses, workers_);
  }
  void pass(double seconds) {
    time_ = time_ + seconds;
    scheduler_->poke();
  }
  void release(const Job& job) { workers_.worker_of(job.id)->complete(); }
  Job wait_for_start(const Job& job) {
    wait_for_event(store_, job.id, "started");
    return wait_for(store_, job.id, JobState::running);
  }
  /// Returns when the scheduler has had a whole round since this call began: each but the first
  /// of these requests is obeyed in a round that began after it was made.
  void wait_for_a_round(const Job& running) {
    for (int i = 0; i < 2; ++i) {
      pass(1.0);
      const int before = count_events(store_, running.id, "checkpoint");
      scheduler_->checkpoint_now(running.id);
      wait_until("a checkpoint", [&] {
        return count_events(store_, running.id, "checkpoint") > before ||
               store_.find(running.id)->state != JobState::running;
      });
    }
  }
  JobState state_of(const Job& job) { return store_.find(job.id)->state; }
  std::string why(const Job& job) { return scheduler_->why_waiting(*store_.find(job.id)); }

  DataFolder data_;
  JobStore store_{data_.path()};
  ServiceLimits limits_ = limits_for_scripts();
  std::atomic<double> time_ = 1000.0;
  std::atomic<std::uint64_t> free_ = std::uint64_t{1} << 40;
  std::atomic<double> core_seconds_ = 0.0;
  std::atomic<bool> runnable_ = false;
  MockExecutor workers_;
  std::optional<Scheduler> scheduler_;
};

TEST_F(SchedulerSensesThread, SmallJobsSlipPastAWideOneForAMinuteAndNoLonger) {
  limits_.stalled_seconds = 1e9;
  const Job first = add_real_job(store_, data_);
  start();
  wait_for_start(first);
  const Job wide = add_real_job(store_, data_, 0.1, 0, 2);
  const Job second = add_real_job(store_, data_);
  pass(1.0);
  wait_for_start(second);
  const Job third = add_real_job(store_, data_);
  pass(58.0);
  release(second);
  wait_for_start(third);

  const Job fourth = add_real_job(store_, data_);
  pass(3.0);
  release(third);
  // Either the wide job sees that a core is kept for it, or the fourth has taken that core.
  wait_until("the choice", [&] {
    return why(wide) == "needs 2 threads, 1 of 2 is free" || state_of(fourth) == JobState::running;
  });
  ASSERT_EQ(state_of(fourth), JobState::queued);
  release(first);
  wait_for_start(wide);
  EXPECT_EQ(state_of(fourth), JobState::queued);
  release(wide);
  wait_for_start(fourth);
}

TEST_F(SchedulerSensesThread, EndsAnAttemptAfterAMinuteWithoutProgressAndNotBefore) {
  limits_.crash_limit = 1;
  const Job job = add_real_job(store_, data_);
  start();
  wait_for_start(job);
  wait_until("its progress", [&] { return !store_.find(job.id)->progress.empty(); });
  pass(56.0);
  wait_for_a_round(job);
  EXPECT_EQ(state_of(job), JobState::running);
  pass(5.0);
  const std::string reason = wait_for(store_, job.id, JobState::failed).reason;
  EXPECT_NE(reason.find("no progress"), std::string::npos) << reason;
}

TEST_F(SchedulerSensesThread, AWorkerThatStandsInLineForACoreIsNotTakenForStuck) {
  limits_.crash_limit = 1;
  const Job job = add_real_job(store_, data_);
  start();
  wait_for_start(job);
  wait_until("its progress", [&] { return !store_.find(job.id)->progress.empty(); });
  runnable_ = true;
  core_seconds_ = 50.0;
  pass(1000.0);
  wait_for_a_round(job);
  EXPECT_EQ(state_of(job), JobState::running);
  core_seconds_ = 70.0;
  pass(1000.0);
  const std::string reason = wait_for(store_, job.id, JobState::failed).reason;
  EXPECT_NE(reason.find("no progress"), std::string::npos) << reason;
}

TEST_F(SchedulerSensesThread, ANearlyFullDiskPausesRunningJobsAndKeepsTheQueue) {
  limits_.disk_reserve = 1000;
  const Job running = add_real_job(store_, data_);
  free_ = 1000;
  start();
  wait_for_start(running);
  const Job waiting = add_real_job(store_, data_);
  free_ = 999;
  pass(2.0);
  const std::string reason = wait_for(store_, running.id, JobState::paused).reason;
  EXPECT_NE(reason.find("disk"), std::string::npos) << reason;
  EXPECT_EQ(store_.find(running.id)->crashes, 0);
  wait_until("the reason for waiting",
             [&] { return why(waiting).find("disk") != std::string::npos; });
  EXPECT_EQ(state_of(waiting), JobState::queued);
  free_ = 1000;
  pass(2.0);
  wait_for_start(waiting);
  EXPECT_EQ(state_of(running), JobState::paused) << "only a person knows that there is room";
}

TEST(Patience, LastsAMinuteFromTheFirstSightOfTheSameJob) {
  Patience patience;
  EXPECT_FALSE(patience.is_over("a", 100.0));
  EXPECT_FALSE(patience.is_over("a", 160.0));
  EXPECT_TRUE(patience.is_over("a", 160.5));
  EXPECT_FALSE(patience.is_over("b", 161.0)) << "another job came to the head";
  EXPECT_TRUE(patience.is_over("b", 221.5));
  patience.forget();
  EXPECT_FALSE(patience.is_over("b", 222.0)) << "it fitted meanwhile";
}

}  // namespace
}  // namespace sluice::test

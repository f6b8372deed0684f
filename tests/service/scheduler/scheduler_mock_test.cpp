#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "tests/service/scheduler/mock_executor.hpp"
#include "tests/service/scheduler/scheduler_support.hpp"

namespace sluice::test {
namespace {

/// Each way in which an attempt can begin and end, without a process and in a time of its own.
class SchedulerMockThread : public ::testing::Test {
 protected:
  void start(MockHabits habits = {}) {
    executor_.set_habits(std::move(habits));
    SchedulerSenses senses;
    senses.clock = [this] { return time_.load(); };
    scheduler_.emplace(store_, data_.path(), limits_, std::filesystem::path(), senses, executor_);
  }
  void start(std::function<void(MockWorker&)> begins) {
    MockHabits habits;
    habits.begins = std::move(begins);
    start(std::move(habits));
  }
  void pass(double seconds) {
    time_ = time_ + seconds;
    scheduler_->poke();
  }
  /// Lets time pass until the job is in that state.
  Job run_until(const Job& job, JobState state) {
    wait_until(to_string(state), [&] {
      pass(1.0);
      return store_.find(job.id)->state == state;
    });
    return *store_.find(job.id);
  }
  Job run(std::function<void(MockWorker&)> begins, JobState state) {
    const Job job = add_real_job(store_, data_);
    start(std::move(begins));
    return run_until(job, state);
  }
  [[nodiscard]] std::string why(const Job& job) const {
    return scheduler_->why_waiting(*store_.find(job.id));
  }

  DataFolder data_;
  JobStore store_{data_.path()};
  ServiceLimits limits_ = limits_for_scripts();
  std::atomic<double> time_ = 1000.0;
  std::atomic<bool> told_ = false;
  std::atomic<bool> listens_ = false;
  std::atomic<bool> told_too_early_ = false;
  MockExecutor executor_;
  std::optional<Scheduler> scheduler_;
};

TEST_F(SchedulerMockThread, CompletesAJobWhoseWorkerIsDone) {
  const Job job = run([](MockWorker& worker) { worker.complete(); }, JobState::completed);
  EXPECT_EQ(job.attempts, 1);
  EXPECT_EQ(history(store_, job.id), "submitted claimed worker_started completed");
}

TEST_F(SchedulerMockThread, TriesAStartThatIsRefusedAgainAndCountsNoCrash) {
  executor_.refuse(EAGAIN);
  const Job job = add_real_job(store_, data_);
  start([](MockWorker& worker) { worker.complete(); });
  wait_for_event(store_, job.id, "requeued");
  EXPECT_EQ(store_.find(job.id)->reason,
            "cannot start a worker: cannot make a process: Resource temporarily unavailable");
  wait_until("the reason for waiting",
             [&] { return why(job) == "waits 1 s because its worker could not begin"; });
  executor_.refuse(0);
  pass(1.0);
  EXPECT_EQ(wait_for(store_, job.id, JobState::completed).crashes, 0);
  EXPECT_EQ(executor_.started(), 1);
}

TEST_F(SchedulerMockThread, PausesAJobWithTheReasonWhenTheSystemGoesOnRefusingToStartIt) {
  executor_.refuse(ENOMEM);
  const Job job = add_real_job(store_, data_);
  start();
  const std::string reason = run_until(job, JobState::paused).reason;
  EXPECT_EQ(reason,
            "cannot start a worker: cannot make a process: Cannot allocate memory; tried 8 times: "
            "mend this, then resume the job");
  EXPECT_EQ(count_events(store_, job.id, "claimed"), 8);
  EXPECT_EQ(executor_.started(), 0);
}

TEST_F(SchedulerMockThread, EndsAJobWhoseCrashRepeats) {
  limits_.crash_limit = 2;
  const Job job = run([](MockWorker& worker) { worker.die(SIGSEGV); }, JobState::failed);
  EXPECT_EQ(job.crashes, 2);
  EXPECT_EQ(executor_.started(), 2);
  EXPECT_NE(job.reason.find("signal 11"), std::string::npos) << job.reason;
}

TEST_F(SchedulerMockThread, TriesAgainAfterACrashAndNotBeforeItsTime) {
  const Job job = add_real_job(store_, data_);
  start([](MockWorker& worker) {
    if (worker.number() > 1) return worker.complete();
    worker.die(SIGKILL);
  });
  wait_for_event(store_, job.id, "requeued");
  wait_until("the reason for waiting",
             [&] { return why(job) == "waits 1 s after its worker was lost"; });
  pass(0.5);
  const Job other = add_real_job(store_, data_);
  scheduler_->poke();
  wait_for(store_, other.id, JobState::completed);
  EXPECT_EQ(store_.find(job.id)->attempts, 1);
  pass(0.5);
  EXPECT_EQ(wait_for(store_, job.id, JobState::completed).attempts, 2);
}

TEST_F(SchedulerMockThread, CountsNoCrashAgainstAJobThatGetsOn) {
  limits_.crash_limit = 2;
  const Job job = run(
      [](MockWorker& worker) {
        if (worker.number() == 4) return worker.complete();
        worker.leave("checkpoint-00000000000" + std::to_string(worker.number()) + ".h5", "");
        worker.die(SIGKILL);
      },
      JobState::completed);
  EXPECT_EQ(job.attempts, 4);
}

TEST_F(SchedulerMockThread, FailsAtOnceWithTheDiagnosisOfANumericalFailure) {
  const Job job = run(
      [](MockWorker& worker) {
        worker.say(R"({"event":"failed","message":"density out of range at step 7"})");
        worker.exit(4);
      },
      JobState::failed);
  EXPECT_EQ(job.reason, "density out of range at step 7");
  EXPECT_EQ(job.attempts, 1);
}

TEST_F(SchedulerMockThread, PausesWhenTheDiskRefuses) {
  const Job job = run(
      [](MockWorker& worker) {
        worker.say_error("sluice: disk full");
        worker.exit(5);
      },
      JobState::paused);
  EXPECT_EQ(job.reason, "sluice: disk full");
}

TEST_F(SchedulerMockThread, WaitsForAFolderThatIsInUse) {
  const Job job = run(
      [](MockWorker& worker) {
        if (worker.number() > 1) return worker.complete();
        worker.exit(7);
      },
      JobState::completed);
  EXPECT_EQ(job.attempts, 2);
  EXPECT_EQ(job.crashes, 0);
}

TEST_F(SchedulerMockThread, EndsAWorkerThatTalksWithoutProgress) {
  limits_.crash_limit = 1;
  const Job job = add_real_job(store_, data_);
  start([](MockWorker& worker) { worker.say(R"({"event":"progress","step":5})"); });
  wait_until("its progress", [&] { return !store_.find(job.id)->progress.empty(); });
  pass(59.0);
  const auto worker = executor_.worker_of(job.id);
  worker->say(R"({"event":"progress","step":5})");
  worker->say(R"({"event":"warning"})");
  wait_for_event(store_, job.id, "warning");
  pass(2.0);
  const std::string reason = wait_for(store_, job.id, JobState::failed).reason;
  EXPECT_NE(reason.find("no progress"), std::string::npos) << reason;
}

TEST_F(SchedulerMockThread, KeepsAWorkerThatProgressesBeyondTheLimitOfStalling) {
  const Job job = add_real_job(store_, data_);
  start();
  wait_for(store_, job.id, JobState::running);
  const auto worker = executor_.worker_of(job.id);
  for (int step = 1; step <= 5; ++step) {
    const std::string text = "\"step\":" + std::to_string(step);
    worker->say(R"({"event":"progress",)" + text + "}");
    wait_until("its progress",
               [&] { return store_.find(job.id)->progress.find(text) != std::string::npos; });
    pass(50.0);
  }
  worker->complete();
  EXPECT_EQ(wait_for(store_, job.id, JobState::completed).attempts, 1);
}

TEST_F(SchedulerMockThread, KillsAWorkerThatDoesNotObeyAndNotBeforeItsTime) {
  const Job job = add_real_job(store_, data_);
  MockHabits habits;
  habits.hears = [this](MockWorker&, int signal) { told_ = signal == SIGTERM; };
  start(habits);
  wait_for(store_, job.id, JobState::running);
  store_.apply(job.id, JobAction::cancel, "", {});
  scheduler_->poke();
  wait_until("the signal", [&] { return told_.load(); });
  pass(limits_.stop_seconds);
  const Job other = add_real_job(store_, data_);
  scheduler_->poke();
  wait_for(store_, other.id, JobState::running);
  EXPECT_EQ(store_.find(job.id)->state, JobState::running);
  pass(1.0);
  EXPECT_EQ(wait_for(store_, job.id, JobState::cancelled).crashes, 0);
  executor_.worker_of(other.id)->complete();
}

TEST_F(SchedulerMockThread, PausesAtTheWallLimit) {
  limits_.wall_seconds_per_attempt = 30.0;
  limits_.stalled_seconds = 1e9;
  const Job job = add_real_job(store_, data_);
  start();
  wait_for(store_, job.id, JobState::running);
  const std::string reason = run_until(job, JobState::paused).reason;
  EXPECT_NE(reason.find("as long as one attempt may"), std::string::npos) << reason;
  EXPECT_GT(time_.load(), 1030.0);
}

TEST_F(SchedulerMockThread, AsksForACheckpointOnceTheWorkerListens) {
  const Job job = add_real_job(store_, data_);
  MockHabits habits;
  habits.hears = [this](MockWorker& worker, int signal) {
    if (signal != SIGUSR1) return worker.exit(85);
    told_too_early_ = !listens_;
    worker.say(R"({"event":"checkpoint","step":3})");
  };
  start(habits);
  wait_for(store_, job.id, JobState::running);
  EXPECT_TRUE(scheduler_->checkpoint_now(job.id));
  const Job other = add_real_job(store_, data_);
  scheduler_->poke();
  wait_for(store_, other.id, JobState::running);  // a round later
  listens_ = true;
  executor_.worker_of(job.id)->say(R"({"event":"started","step":0})");
  wait_for_event(store_, job.id, "checkpoint");
  EXPECT_FALSE(told_too_early_);
  EXPECT_FALSE(scheduler_->checkpoint_now("j00000000000000000000"));
}

}  // namespace
}  // namespace sluice::test

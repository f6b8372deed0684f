#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <optional>
#include <string>

#include "engine/execute/sandbox.hpp"
#include "engine/store/files/job_folder.hpp"
#include "tests/service/scheduler/scheduler_support.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

/// The program itself as the worker, in its sandbox.
class SchedulerSluiceThread : public ::testing::Test {
 protected:
  void start() { scheduler_.emplace(store_, data_.path(), limits_, sluice_program()); }
  std::string undisturbed_digest() {
    const Job job = add_slow_job(store_, data_);
    if (!scheduler_) start();
    scheduler_->poke();
    return physics_digest_of(wait_for(store_, job.id, JobState::completed));
  }
  /// Waits until the job has a checkpoint that its present attempt wrote.
  void wait_for_checkpoint(const Job& job, int count) {
    wait_until("a checkpoint", [&] { return count_events(store_, job.id, "checkpoint") >= count; });
  }

  DataFolder data_;
  JobStore store_{data_.path()};
  ServiceLimits limits_ = limits_for_sluice();
  std::optional<Scheduler> scheduler_;
};

TEST_F(SchedulerSluiceThread, RunsAScene) {
  const Job job = add_real_job(store_, data_, 0.5);
  start();
  const Job done = wait_for(store_, job.id, JobState::completed);
  EXPECT_EQ(physics_digest_of(done).size(), 64U);
  EXPECT_GE(count_events(store_, job.id, "started"), 1);
}

TEST_F(SchedulerSluiceThread, ItsWorkersNeverNameThePlaceOfTheDataFolder) {
  const Job job = add_real_job(store_, data_);
  const JobPaths paths(data_.job(job.id));
  write_file(paths.checkpoint(7), "no checkpoint");
  start();
  const Job failed = wait_for(store_, job.id, JobState::failed);
  EXPECT_NE(failed.reason.find("checkpoint"), std::string::npos) << failed.reason;
  std::string said = failed.reason + failed.outcome + read_file(paths.log());
  for (const JobEvent& event : store_.events(job.id, 0, 10000)) said += event.detail;
  EXPECT_EQ(said.find(data_.path().string()), std::string::npos) << said;
}

TEST_F(SchedulerSluiceThread, ConfinesItsWorkers) {
  const Job job = add_endless_job(store_, data_);
  start();
  wait_for_event(store_, job.id, "started");
  const std::string status =
      read_file("/proc/" + std::to_string(worker_pid(store_, job.id)) + "/status");
  EXPECT_NE(status.find("NoNewPrivs:\t1"), std::string::npos) << status;
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  if (Sandbox::missing().find("seccomp") == std::string::npos) {
    EXPECT_NE(status.find("Seccomp:\t2"), std::string::npos) << status;
  }
#endif
  store_.apply(job.id, JobAction::cancel, "", {});
  scheduler_->poke();
  wait_for(store_, job.id, JobState::cancelled);
}

TEST_F(SchedulerSluiceThread, GoesOnAfterKillsToTheSameDigest) {
  const std::string expected = undisturbed_digest();
  const Job job = add_slow_job(store_, data_);
  scheduler_->poke();
  wait_for_checkpoint(job, 1);
  ::kill(worker_pid(store_, job.id), SIGKILL);
  const Job done = wait_for(store_, job.id, JobState::completed);
  EXPECT_EQ(done.attempts, 2);
  EXPECT_EQ(physics_digest_of(done), expected);
}

TEST_F(SchedulerSluiceThread, DrainsToACheckpointAndGoesOnToTheSameDigest) {
  const std::string expected = undisturbed_digest();
  const Job job = add_slow_job(store_, data_);
  scheduler_->poke();
  wait_for_event(store_, job.id, "started");
  scheduler_.reset();
  const Job drained = store_.find(job.id).value();
  EXPECT_EQ(drained.crashes, 0);
  start();
  const Job done = wait_for(store_, job.id, JobState::completed);
  EXPECT_EQ(done.attempts, 2);
  EXPECT_EQ(physics_digest_of(done), expected);
}

TEST_F(SchedulerSluiceThread, WritesACheckpointWhenAsked) {
  const Job job = add_endless_job(store_, data_);
  start();
  wait_for_checkpoint(job, 1);
  wait_until("progress", [&] { return !store_.find(job.id)->progress.empty(); });
  EXPECT_TRUE(scheduler_->checkpoint_now(job.id));
  wait_for_checkpoint(job, 2);
  EXPECT_EQ(store_.find(job.id)->state, JobState::running);
  store_.apply(job.id, JobAction::pause, "", {});
  scheduler_->poke();
  wait_for(store_, job.id, JobState::paused);
  EXPECT_FALSE(JobPaths(data_.job(job.id)).checkpoints().empty());
}

TEST_F(SchedulerSluiceThread, LeavesNoZombieAndNoDescriptor) {
  const auto descriptors = [] {
    return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
  };
  const auto before = descriptors();
  const Job job = add_real_job(store_, data_, 0.2);
  start();
  wait_for(store_, job.id, JobState::completed);
  scheduler_.reset();
  EXPECT_EQ(descriptors(), before);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

}  // namespace
}  // namespace sluice::test

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <memory>
#include <optional>
#include <string>

#include "engine/store/files/job_folder.hpp"
#include "service/worker/orphan.hpp"
#include "tests/service/scheduler/scheduler_support.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

/// A service that finds jobs marked running.
class SchedulerRecoveryThread : public ::testing::Test {
 protected:
  SchedulerRecoveryThread() : store_(std::make_unique<JobStore>(data_.path())) {
    limits_.crash_limit = 2;
  }
  /// A job that a service claimed, and then there was no service any more.
  Job add_claimed() {
    const Job job = add_real_job(*store_, data_);
    return store_->claim(1, {}).value();
  }
  void start(std::string_view script) {
    scheduler_.emplace(*store_, data_.path(), limits_, write_worker(data_, script));
  }
  void put_outcome(const Job& job, std::string_view state, int code, double end_time) {
    write_file(JobPaths(data_.job(job.id)).outcome(),
               R"({"state":")" + std::string(state) + R"(","exit_code":)" + std::to_string(code) +
                   R"(,"reason":"as written","end_time":)" + std::to_string(end_time) + "}");
  }

  DataFolder data_;
  ServiceLimits limits_ = limits_for_scripts();
  std::unique_ptr<JobStore> store_;
  std::optional<Scheduler> scheduler_;
};

TEST_F(SchedulerRecoveryThread, CompletesWhatReachedItsEndBeforeTheRowWasUpdated) {
  const Job job = add_claimed();
  put_outcome(job, "completed", 0, 0.1);
  start("exit 1");
  EXPECT_EQ(wait_for(*store_, job.id, JobState::completed).attempts, 1);
}

TEST_F(SchedulerRecoveryThread, RunsAnExtendedJobWhoseOldOutcomeIsStillThere) {
  const Job job = add_claimed();
  put_outcome(job, "completed", 0, 0.05);
  start(kComplete);
  EXPECT_EQ(wait_for(*store_, job.id, JobState::completed).attempts, 2);
}

TEST_F(SchedulerRecoveryThread, QueuesWhatWasStoppedWithACheckpointAndCountsNoCrash) {
  const Job job = add_claimed();
  put_outcome(job, "stopped", 85, 0.1);
  start(kComplete);
  const Job done = wait_for(*store_, job.id, JobState::completed);
  EXPECT_EQ(done.attempts, 2);
  EXPECT_EQ(done.crashes, 0);
}

TEST_F(SchedulerRecoveryThread, FailsWhatAGuardEnded) {
  const Job job = add_claimed();
  put_outcome(job, "failed", 4, 0.1);
  start(kComplete);
  EXPECT_EQ(wait_for(*store_, job.id, JobState::failed).reason, "as written");
}

TEST_F(SchedulerRecoveryThread, CountsALostWorkerAsACrash) {
  const Job job = add_claimed();
  start("kill -9 $$");
  EXPECT_EQ(wait_for(*store_, job.id, JobState::failed).crashes, 2);
}

TEST_F(SchedulerRecoveryThread, ObeysACancelThatTheLastServiceDidNotLiveToObey) {
  const Job job = add_claimed();
  store_->apply(job.id, JobAction::cancel, "", {});
  start(kComplete);
  wait_for(*store_, job.id, JobState::cancelled);
}

TEST_F(SchedulerRecoveryThread, WaitsForAWorkerThatStillHoldsTheFolder) {
  const Job job = add_claimed();
  std::optional<FolderLock> lock(JobPaths(data_.job(job.id)).lock());
  start(kComplete);
  const Job other = add_real_job(*store_, data_);
  scheduler_->poke();
  wait_for(*store_, other.id, JobState::completed);
  EXPECT_EQ(store_->find(job.id)->state, JobState::running);
  EXPECT_EQ(store_->find(job.id)->attempts, 1);
  lock.reset();
  EXPECT_EQ(wait_for(*store_, job.id, JobState::completed).attempts, 2);
}

TEST_F(SchedulerRecoveryThread, KillsAWorkerOfTheLastServiceThatDoesNotObeyButNobodyElse) {
  const Job job = add_claimed();
  const JobPaths paths(data_.job(job.id));
  const pid_t holder = ::fork();
  if (holder == 0) {
    const std::string path = paths.lock().string();
    const std::string token = std::string("SLUICE_ATTEMPT=") + job.token;
    const std::string script = "trap '' TERM; exec 9<>" + path + "; flock 9; echo $$ > " + path +
                               "; while :; do sleep 0.05; done";
    const char* const arguments[] = {"bash", "-c", script.c_str(), nullptr};
    const char* const environment[] = {token.c_str(), "PATH=/usr/bin:/bin", nullptr};
    ::execve("/bin/bash", const_cast<char* const*>(arguments),
             const_cast<char* const*>(environment));
    ::_exit(127);
  }
  wait_until("the holder", [&] {
    return is_in_use(paths) && read_file(paths.lock()) == std::to_string(holder) + "\n";
  });
  EXPECT_FALSE(kill_orphan(paths, "another-token"));
  EXPECT_EQ(::waitpid(holder, nullptr, WNOHANG), 0) << "it was killed for another attempt";
  limits_.stop_seconds = 0.2;
  start(kComplete);
  int status = 0;
  EXPECT_EQ(::waitpid(holder, &status, 0), holder);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  wait_for(*store_, job.id, JobState::completed);
}

/// The service in a process of its own, which is then killed.
TEST_F(SchedulerRecoveryThread, TheProgramGoesOnAfterTheServiceWasKilled) {
  limits_ = limits_for_sluice();
  const Job reference = add_slow_job(*store_, data_);
  scheduler_.emplace(*store_, data_.path(), limits_, sluice_program());
  const std::string expected =
      physics_digest_of(wait_for(*store_, reference.id, JobState::completed));
  const Job job = add_slow_job(*store_, data_);
  scheduler_.reset();
  store_.reset();
  const pid_t service = ::fork();
  if (service == 0) {
    JobStore store(data_.path());
    const Scheduler scheduler(store, data_.path(), limits_, sluice_program());
    for (;;) ::pause();
  }
  wait_until("the run", [&] {
    return !JobPaths(data_.job(job.id)).checkpoints().empty() ||
           fs::exists(JobPaths(data_.job(job.id)).outcome());
  });
  ::kill(service, SIGKILL);
  ::waitpid(service, nullptr, 0);
  store_ = std::make_unique<JobStore>(data_.path());
  scheduler_.emplace(*store_, data_.path(), limits_, sluice_program());
  const Job done = wait_for(*store_, job.id, JobState::completed);
  EXPECT_EQ(done.attempts, 2);
  EXPECT_EQ(physics_digest_of(done), expected);
}

}  // namespace
}  // namespace sluice::test

#include <gtest/gtest.h>

#include <csignal>
#include <memory>
#include <optional>
#include <string>

#include "engine/store/files/job_folder.hpp"
#include "tests/service/scheduler/scheduler_support.hpp"

namespace sluice::test {
namespace {

/// Scripts in place of workers: what processes do, with the scheduler's thread. What follows from
/// how they end is in scheduler_mock_test.cpp.
class SchedulerThread : public ::testing::Test {
 protected:
  /// Runs jobs with this script as their worker.
  void start(std::string_view script) {
    scheduler_.emplace(store_, data_.path(), limits_, write_worker(data_, script));
  }
  void start(std::initializer_list<std::string_view> lines) {
    std::string script;
    for (const std::string_view line : lines) script.append(line).append("\n");
    start(script);
  }
  /// Adds a job and waits for its end.
  Job run(std::string_view script, JobState state) {
    const Job job = add_real_job(store_, data_);
    start(script);
    return wait_for(store_, job.id, state);
  }
  [[nodiscard]] std::string attempts_of(const Job& job) {
    return read_file(data_.job(job.id) / "n");
  }

  DataFolder data_;
  JobStore store_{data_.path()};
  ServiceLimits limits_ = limits_for_scripts();
  std::optional<Scheduler> scheduler_;
};

TEST_F(SchedulerThread, CompletesAJobWithItsOutcome) {
  const Job job = run(kComplete, JobState::completed);
  EXPECT_NE(job.outcome.find("completed"), std::string::npos);
  EXPECT_EQ(job.attempts, 1);
  EXPECT_EQ(history(store_, job.id), "submitted claimed worker_started completed");
}

TEST_F(SchedulerThread, StartsTheWorkerInItsFolderWithThreadsAndTheFormOfItsLines) {
  limits_.cores = 3;
  const Job job = add_real_job(store_, data_, 0.1, 0, 3);
  start({R"(echo "$PWD: $@" > "$2/arguments")", kComplete});
  wait_for(store_, job.id, JobState::completed);
  EXPECT_EQ(read_file(data_.job(job.id) / "arguments"),
            data_.job(job.id).string() + ": run . --threads 3 --progress json\n");
}

TEST_F(SchedulerThread, EndsAJobWhoseCrashRepeats) {
  limits_.crash_limit = 2;
  const Job job = run("kill -SEGV $$", JobState::failed);
  EXPECT_EQ(job.crashes, 2);
  EXPECT_EQ(attempts_of(job), "2\n");
  EXPECT_NE(job.reason.find("signal 11"), std::string::npos) << job.reason;
}

TEST_F(SchedulerThread, TakesTheReasonFromStderrWhereNoLineTellsIt) {
  const Job job = run("echo 'sluice: nothing usable here' >&2; exit 6", JobState::failed);
  EXPECT_EQ(job.reason, "sluice: nothing usable here");
  EXPECT_NE(read_file(data_.job(job.id) / "worker.log").find("nothing usable"), std::string::npos);
}

TEST_F(SchedulerThread, SurvivesGarbageAndEndlessLines) {
  const Job job = run(
      R"(head -c 300000 /dev/zero | tr '\0' x; echo
head -c 20000 /dev/urandom; echo
echo '[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[['
echo '{"event":"progress","step":9}'
echo '{"event":"checkpoint","step":10}'
)" + std::string(kComplete),
      JobState::completed);
  EXPECT_GE(count_events(store_, job.id, "warning"), 3);
  EXPECT_EQ(count_events(store_, job.id, "checkpoint"), 1);
}

TEST_F(SchedulerThread, BoundsWhatAFloodOfOutputLeaves) {
  const Job job = run(
      R"(for i in $(seq 1 3000); do echo '{"event":"warning","message":"w"}'; done
head -c 3000000 /dev/zero | tr '\0' y >&2
)" + std::string(kComplete),
      JobState::completed);
  EXPECT_LE(count_events(store_, job.id, "warning"), 100);
  EXPECT_LE(std::filesystem::file_size(data_.job(job.id) / "worker.log"), 300U << 10);
}

// A worker that obeys: a checkpoint, exit 85.
constexpr std::string_view kObeys =
    R"(trap 'touch "$2/obeyed"; exit 85' TERM
echo '{"event":"started","step":0}'
while :; do sleep 0.02; done)";

TEST_F(SchedulerThread, PausesCancelsAndResumesARunningJob) {
  const Job job = add_real_job(store_, data_);
  const Job other = add_real_job(store_, data_);
  start(kObeys);
  wait_for_event(store_, job.id, "started");
  wait_for_event(store_, other.id, "started");
  store_.apply(job.id, JobAction::pause, "", {});
  store_.apply(other.id, JobAction::cancel, "", {});
  scheduler_->poke();
  wait_for(store_, job.id, JobState::paused);
  wait_for(store_, other.id, JobState::cancelled);
  EXPECT_TRUE(std::filesystem::exists(data_.job(job.id) / "obeyed"));
  store_.apply(job.id, JobAction::resume, "", {});
  scheduler_->poke();
  EXPECT_EQ(wait_for(store_, job.id, JobState::running).attempts, 2);
}

TEST_F(SchedulerThread, KillsAWorkerThatDoesNotObey) {
  limits_.stop_seconds = 0.2;
  const Job job = add_real_job(store_, data_);
  start({"trap '' TERM", kSayStarted, "while :; do sleep 0.02; done"});
  wait_for_event(store_, job.id, "started");
  store_.apply(job.id, JobAction::cancel, "", {});
  scheduler_->poke();
  EXPECT_EQ(wait_for(store_, job.id, JobState::cancelled).crashes, 0);
}

TEST_F(SchedulerThread, PausesAJobThatTakesTooMuchOfTheDisk) {
  limits_.disk_per_job = 1 << 20;
  const Job job = add_real_job(store_, data_);
  // Two files, because one alone is bounded by the limit of its size.
  write_file(data_.job(job.id) / "a", std::string(700 << 10, 'x'));
  write_file(data_.job(job.id) / "b", std::string(700 << 10, 'x'));
  start(kObeys);
  EXPECT_NE(wait_for(store_, job.id, JobState::paused).reason.find("disk"), std::string::npos);
}

TEST_F(SchedulerThread, PausesAllAndStartsNoneWhileTheDiskIsNearlyFull) {
  const Job running = add_real_job(store_, data_);
  // Held by the first service; the second finds it running and the disk full.
  limits_.disk_reserve = std::uint64_t{1} << 62;
  start(kObeys);
  wait_until("the disk guard", [&] {
    return scheduler_->why_waiting(store_.find(running.id).value()).find("disk") !=
           std::string::npos;
  });
  EXPECT_EQ(store_.find(running.id)->state, JobState::queued);
  EXPECT_EQ(store_.find(running.id)->attempts, 0);
}

TEST_F(SchedulerThread, DrainsIntoTheQueueAndTheNextServiceGoesOn) {
  const Job job = add_real_job(store_, data_);
  start(kObeys);
  wait_for_event(store_, job.id, "started");
  scheduler_->drain();
  EXPECT_EQ(store_.find(job.id)->state, JobState::queued);
  EXPECT_EQ(store_.find(job.id)->crashes, 0);
  EXPECT_EQ(scheduler_->why_waiting(store_.find(job.id).value()), "the service is draining");
  scheduler_->drain();
  scheduler_->poke();
  scheduler_.reset();
  start(kComplete);
  wait_for(store_, job.id, JobState::completed);
}

TEST_F(SchedulerThread, FailsAJobWhoseFolderIsGone) {
  const Job job = add_real_job(store_, data_);
  std::filesystem::remove_all(data_.job(job.id));
  start(kComplete);
  EXPECT_NE(wait_for(store_, job.id, JobState::failed).reason.find("gone"), std::string::npos);
}

TEST_F(SchedulerThread, AFolderThatCannotBeLookedAtIsAnErrorOfItsJobAlone) {
  const Job job = add_real_job(store_, data_, 0.1, 1);  // the first of the queue
  const Job other = add_real_job(store_, data_);
  const auto scene = data_.job(job.id) / "scene.json";
  std::filesystem::remove(scene);
  std::filesystem::create_symlink(scene.filename(), scene);
  start(kComplete);
  wait_for(store_, other.id, JobState::completed);
  wait_for_event(store_, job.id, "requeued");
  const Job waiting = *store_.find(job.id);
  EXPECT_EQ(waiting.state, JobState::queued);
  EXPECT_EQ(waiting.crashes, 0);
  EXPECT_NE(waiting.reason.find("scene.json"), std::string::npos) << waiting.reason;
  EXPECT_EQ(waiting.reason.find(data_.path().string()), std::string::npos) << waiting.reason;
}

TEST_F(SchedulerThread, WaitsWhenNoWorkerCanBeStarted) {
  const Job job = add_real_job(store_, data_);
  scheduler_.emplace(store_, data_.path(), limits_, data_.path() / "missing");
  wait_for_event(store_, job.id, "requeued");
  EXPECT_NE(store_.find(job.id)->reason.find("cannot start a worker"), std::string::npos);
  EXPECT_EQ(store_.find(job.id)->crashes, 0);
}

TEST_F(SchedulerThread, DeletesEndedJobsAfterTheirTime) {
  limits_.retention_days = 1e-9;
  const Job job = add_real_job(store_, data_);
  start(kComplete);
  wait_until("the deletion", [&] { return !store_.find(job.id); });
  wait_until("its folder to go", [&] { return !std::filesystem::exists(data_.job(job.id)); });
}

TEST_F(SchedulerThread, KeepsEndedJobsWithoutALimit) {
  const Job job = run(kComplete, JobState::completed);
  const Job next = add_real_job(store_, data_);
  scheduler_->poke();
  wait_for(store_, next.id, JobState::completed);
  EXPECT_TRUE(store_.find(job.id));
}

}  // namespace
}  // namespace sluice::test

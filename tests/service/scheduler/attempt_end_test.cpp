#include "service/scheduler/attempt_end.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <string>

#include "engine/run/exit_code.hpp"
#include "service/jobs/worker_exit.hpp"
#include "service/scheduler/back_offs.hpp"
#include "tests/service/scheduler/scheduler_support.hpp"

namespace sluice::test {
namespace {

constexpr int kLimit = 3;

AttemptFacts exited(int code, StopCause cause = StopCause::none) {
  AttemptFacts facts;
  facts.end = ProcessEnd{code, 0};
  facts.cause = cause;
  return facts;
}

AttemptFacts killed(int signal, StopCause cause = StopCause::none) {
  AttemptFacts facts;
  facts.end = ProcessEnd{-1, signal};
  facts.cause = cause;
  return facts;
}

FreshOutcome outcome(const std::string& state, int code, bool at_end) {
  return {"{}", state, code, "because", at_end};
}

TEST(AttemptEnd, ExitCodesAreThoseOfTheProgram) {
  EXPECT_EQ(WorkerExit::done, static_cast<int>(ExitCode::done));
  EXPECT_EQ(WorkerExit::usage, static_cast<int>(ExitCode::usage));
  EXPECT_EQ(WorkerExit::invalid_scene, static_cast<int>(ExitCode::invalid_scene));
  EXPECT_EQ(WorkerExit::numerical_failure, static_cast<int>(ExitCode::numerical_failure));
  EXPECT_EQ(WorkerExit::storage_failure, static_cast<int>(ExitCode::storage_failure));
  EXPECT_EQ(WorkerExit::no_usable_checkpoint, static_cast<int>(ExitCode::no_usable_checkpoint));
  EXPECT_EQ(WorkerExit::folder_locked, static_cast<int>(ExitCode::folder_locked));
  EXPECT_EQ(WorkerExit::checkpointed, static_cast<int>(ExitCode::checkpointed));
}

TEST(AttemptEnd, CompletedIsWhatTheFolderSaysIsCompleted) {
  AttemptFacts facts = exited(WorkerExit::done);
  facts.outcome = outcome("completed", 0, true);
  EXPECT_EQ(judge(facts, kLimit).action, JobAction::complete);
  facts.end = ProcessEnd{-1, SIGKILL};
  EXPECT_EQ(judge(facts, kLimit).action, JobAction::complete) << "killed after its outcome";
  facts.cause = StopCause::drain;
  EXPECT_EQ(judge(facts, kLimit).action, JobAction::complete) << "stopped too late";
  facts.end.reset();
  EXPECT_EQ(judge(facts, kLimit).action, JobAction::complete) << "nobody watched";
}

TEST(AttemptEnd, ExitCodeZeroWithoutAnOutcomeIsNoCompletion) {
  EXPECT_EQ(judge(exited(WorkerExit::done), kLimit).action, JobAction::requeue);
  AttemptFacts facts = exited(WorkerExit::done);
  facts.outcome = outcome("completed", 0, false);
  EXPECT_EQ(judge(facts, kLimit).action, JobAction::requeue) << "at an earlier end time";
}

TEST(AttemptEnd, ALostWorkerCountsAsACrashUntilTheLimit) {
  AttemptFacts facts = killed(SIGKILL);
  AttemptVerdict verdict = judge(facts, kLimit);
  EXPECT_EQ(verdict.action, JobAction::requeue);
  EXPECT_EQ(verdict.change.crashes, 1);
  EXPECT_EQ(verdict.next, NextTry::after_crash);
  facts.crashes = 1;
  EXPECT_EQ(judge(facts, kLimit).change.crashes, 2);
  facts.crashes = 2;
  verdict = judge(facts, kLimit);
  EXPECT_EQ(verdict.action, JobAction::fail);
  EXPECT_EQ(verdict.change.crashes, 3);
  EXPECT_NE(verdict.change.reason->find("3 attempts"), std::string::npos);
}

TEST(AttemptEnd, ProgressPastANewerCheckpointStartsTheCountAnew) {
  AttemptFacts facts = killed(SIGSEGV);
  facts.crashes = 2;
  facts.progressed = true;
  const AttemptVerdict verdict = judge(facts, kLimit);
  EXPECT_EQ(verdict.action, JobAction::requeue);
  EXPECT_EQ(verdict.change.crashes, 1);
}

TEST(AttemptEnd, AStalledWorkerIsLost) {
  const AttemptVerdict verdict = judge(killed(SIGKILL, StopCause::stalled), kLimit);
  EXPECT_EQ(verdict.action, JobAction::requeue);
  EXPECT_EQ(verdict.change.crashes, 1);
  EXPECT_NE(verdict.change.reason->find("no progress"), std::string::npos);
}

TEST(AttemptEnd, APlannedStopIsNoCrash) {
  for (const StopCause cause : {StopCause::asked, StopCause::drain}) {
    for (const AttemptFacts& facts : {exited(WorkerExit::checkpointed, cause),
                                      killed(SIGTERM, cause), killed(SIGKILL, cause)}) {
      const AttemptVerdict verdict = judge(facts, kLimit);
      EXPECT_EQ(verdict.action, JobAction::requeue);
      EXPECT_EQ(verdict.change.crashes.value_or(0), 0);
      EXPECT_EQ(verdict.next, NextTry::at_once);
    }
  }
}

TEST(AttemptEnd, LimitsPauseWithAReason) {
  for (const StopCause cause :
       {StopCause::wall_limit, StopCause::disk_low, StopCause::disk_limit}) {
    const AttemptVerdict verdict = judge(exited(WorkerExit::checkpointed, cause), kLimit);
    EXPECT_EQ(verdict.action, JobAction::pause);
    EXPECT_FALSE(verdict.change.reason->empty());
  }
}

TEST(AttemptEnd, AWorkerThatStopsUnaskedWithoutProgressIsACrash) {
  AttemptFacts facts = exited(WorkerExit::checkpointed);
  EXPECT_EQ(judge(facts, kLimit).change.crashes, 1);
  facts.crashes = 2;
  EXPECT_EQ(judge(facts, kLimit).action, JobAction::fail) << "else it would do so for ever";
  facts.progressed = true;
  EXPECT_EQ(judge(facts, kLimit).action, JobAction::requeue);
  EXPECT_EQ(judge(facts, kLimit).change.crashes, 0);
}

TEST(AttemptEnd, AStopThatNobodyWatchedIsPlanned) {
  AttemptFacts facts;
  facts.crashes = 2;
  facts.outcome = outcome("stopped", WorkerExit::checkpointed, false);
  EXPECT_EQ(judge(facts, kLimit).action, JobAction::requeue);
  facts.outcome.reset();
  EXPECT_EQ(judge(facts, kLimit).action, JobAction::fail) << "nothing on disk: it was lost";
}

TEST(AttemptEnd, FailuresThatRepeatAlikeAreNotTriedAgain) {
  for (const int code : {WorkerExit::numerical_failure, WorkerExit::no_usable_checkpoint,
                         WorkerExit::invalid_scene, WorkerExit::usage}) {
    AttemptFacts facts = exited(code);
    facts.message = "the reason";
    const AttemptVerdict verdict = judge(facts, kLimit);
    EXPECT_EQ(verdict.action, JobAction::fail) << code;
    EXPECT_EQ(verdict.change.reason, "the reason") << code;
  }
}

TEST(AttemptEnd, AFullDiskPausesAndALockedFolderWaits) {
  EXPECT_EQ(judge(exited(WorkerExit::storage_failure), kLimit).action, JobAction::pause);
  AttemptFacts facts = exited(WorkerExit::folder_locked);
  facts.crashes = 2;
  const AttemptVerdict verdict = judge(facts, kLimit);
  EXPECT_EQ(verdict.action, JobAction::requeue);
  EXPECT_FALSE(verdict.change.crashes) << "not the job's fault";
  EXPECT_EQ(verdict.next, NextTry::after_lock);
}

TEST(BackOffs, DoubleUpToAMinute) {
  const double expected[] = {1, 2, 4, 8, 16, 32, 60, 60};
  for (int count = 1; count <= 8; ++count) {
    EXPECT_EQ(back_off(count), expected[count - 1]) << count;
  }
  EXPECT_EQ(back_off(1000000), 60.0);
}

TEST(BackOffs, LocksInARowGrowAndAnythingElseStartsAnew) {
  BackOffs waits;
  waits.note("a", NextTry::after_lock, 0, 100.0);
  EXPECT_EQ(waits.find("a", 100.0)->until, 101.0);
  waits.note("a", NextTry::after_lock, 0, 101.0);
  EXPECT_EQ(waits.find("a", 101.0)->until, 103.0);
  EXPECT_EQ(waits.waiting(102.0), std::vector<std::string>{"a"});
  EXPECT_TRUE(waits.waiting(103.0).empty());
  waits.note("a", NextTry::after_crash, 3, 110.0);
  EXPECT_EQ(waits.find("a", 110.0)->until, 114.0);
  waits.note("a", NextTry::at_once, 0, 111.0);
  EXPECT_FALSE(waits.find("a", 111.0));
}

class OutcomeFile : public ::testing::Test {
 protected:
  OutcomeFile() {
    std::filesystem::create_directories(paths_.root());
    job_.end_time = 2.0;
  }
  void put(double end_time) {
    write_file(paths_.outcome(), R"({"state":"completed","exit_code":0,"reason":"","end_time":)" +
                                     std::to_string(end_time) + "}");
  }
  DataFolder data_;
  JobPaths paths_{data_.job("j")};
  Job job_;
};

TEST_F(OutcomeFile, OfAnEarlierEndTimeDoesNotCompleteAnExtendedJob) {
  put(1.0);
  ASSERT_TRUE(fresh_outcome(paths_, job_));
  EXPECT_FALSE(fresh_outcome(paths_, job_)->at_end);
  put(2.0);
  EXPECT_TRUE(fresh_outcome(paths_, job_)->at_end);
}

TEST_F(OutcomeFile, OfAnEarlierAttemptSaysNothing) {
  put(2.0);
  job_.started_ms = std::int64_t{1} << 50;
  EXPECT_FALSE(fresh_outcome(paths_, job_));
}

TEST_F(OutcomeFile, ThatIsDamagedSaysNothing) {
  for (const char* text : {"", "{", "[]", "17", R"({"state":1})", R"({"state":"completed"})"}) {
    write_file(paths_.outcome(), text);
    EXPECT_FALSE(fresh_outcome(paths_, job_)) << text;
  }
}

}  // namespace
}  // namespace sluice::test

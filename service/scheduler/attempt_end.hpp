#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "engine/execute/executor.hpp"
#include "engine/store/files/job_folder.hpp"
#include "service/jobs/job.hpp"
#include "service/jobs/job_store.hpp"

namespace sluice {

/// Why the service asked a worker to stop, or killed it.
enum class StopCause {
  none,
  asked,       ///< a user's pause or cancel
  drain,       ///< the service stops
  wall_limit,  ///< the attempt ran as long as it may
  disk_low,    ///< the disk of all jobs
  disk_limit,  ///< the job's own share of it
  stalled,     ///< killed: it made no progress
};

/// What outcome.json says, when it is of the attempt in question.
struct FreshOutcome {
  std::string text;
  std::string state;  ///< completed, stopped or failed
  int exit_code = -1;
  std::string reason;
  bool at_end = false;  ///< completed, and at the end time that the job has now
};

/// Reads it. Nothing when there is none, it is unreadable, or it was written before the job's last
/// attempt began: an extended job keeps the old one until its worker has come up.
[[nodiscard]] std::optional<FreshOutcome> fresh_outcome(const JobPaths& paths, const Job& job);
/// The same from the line that a worker wrote last, for one that could not write its file.
[[nodiscard]] std::optional<FreshOutcome> told_outcome(const std::string& text, const Job& job);
/// Whether a checkpoint was written since the job's last attempt began.
[[nodiscard]] bool made_checkpoint(const JobPaths& paths, const Job& job);

/// All that decides what becomes of a job whose attempt ended.
struct AttemptFacts {
  std::optional<ProcessEnd> end;  ///< nothing: nobody saw it, the service was not there
  StopCause cause = StopCause::none;
  std::optional<FreshOutcome> outcome;
  bool progressed = false;  ///< it left a newer checkpoint than it found
  int crashes = 0;          ///< the job's, before
  std::string message;      ///< what the worker said last about why it ended
};

/// Which kind of pause comes before the next attempt.
enum class NextTry { at_once, after_crash, after_lock, after_refusal };

struct AttemptVerdict {
  JobAction action = JobAction::requeue;
  JobChange change;
  NextTry next = NextTry::at_once;
};

/// The table of service/README.md, "said by the attempt".
[[nodiscard]] AttemptVerdict judge(const AttemptFacts& facts, int crash_limit);

/// Seconds before the next attempt after `count` crashes or held locks in a row: 1, 2, 4, ... 60.
[[nodiscard]] double back_off(int count);

}  // namespace sluice

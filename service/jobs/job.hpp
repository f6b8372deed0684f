#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace sluice {

/// queued -> running -> completed | failed | cancelled, running -> paused -> queued.
enum class JobState { queued, running, paused, completed, failed, cancelled };
[[nodiscard]] std::string_view to_string(JobState state);
[[nodiscard]] std::optional<JobState> job_state(std::string_view word);
/// completed, failed and cancelled.
[[nodiscard]] bool is_ended(JobState state);

/// What happens to a job. The table of transitions (transitions.hpp) says what each does in which
/// state.
enum class JobAction {
  claim,     ///< the scheduler takes it: queued -> running
  complete,  ///< its worker reached the end
  fail,      ///< numerical failure, no usable checkpoint, or the crash limit
  requeue,   ///< its worker was lost, or drained: running -> queued
  pause,     ///< asked for, or the disk is full
  resume,    ///< paused or cancelled -> queued; completed or failed with a later end time, too
  cancel,
  release,  ///< its worker checkpointed because a pause was asked for: running -> paused
};
[[nodiscard]] std::string_view to_string(JobAction action);

/// A request that a running worker has yet to obey.
enum class PendingStop { none, pause, cancel };
[[nodiscard]] std::string_view to_string(PendingStop stop);
[[nodiscard]] std::optional<PendingStop> pending_stop(std::string_view word);

/// The scheduling row of a job. All physics is in its folder, DATA/jobs/<id>.
struct Job {
  std::string id;  ///< ours: "j" and 20 characters of [0-9a-v], sorting by creation
  JobState state = JobState::queued;
  PendingStop pending_stop = PendingStop::none;
  std::string name;   ///< of the scene
  std::string label;  ///< the user's, may be empty
  int priority = 0;   ///< higher runs first
  int threads = 1;
  std::int64_t created_ms = 0;  ///< Unix time, ms
  std::int64_t updated_ms = 0;
  std::int64_t started_ms = 0;  ///< of the last attempt; 0 before the first
  std::int64_t ended_ms = 0;    ///< 0 until it ended
  std::string token;            ///< of the attempt that may change a running job; empty otherwise
  int attempts = 0;
  int crashes = 0;         ///< lost attempts since the last progress
  std::string reason;      ///< why it is paused, failed or waiting, for a person
  std::string scene_hash;  ///< of the scene's identity text
  double end_time = 0.0;   ///< model time, s
  std::string estimate;    ///< JSON: particles, steps, memory_bytes, disk_bytes, seconds
  std::string progress;    ///< JSON: the last progress line of its worker; empty before the first
  std::string outcome;     ///< JSON: outcome.json of the last attempt that ended; empty before
};

/// One line of a job's history, append-only, numbered over all jobs.
struct JobEvent {
  std::int64_t number = 0;
  std::string job;
  std::int64_t time_ms = 0;
  std::string
      name;  ///< submitted, claimed, progress is not stored, checkpoint, requeued, paused, ...
  std::string detail;  ///< JSON object
};

}  // namespace sluice

#include "service/jobs/transitions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "service/jobs/job_json.hpp"
#include "service/jobs/worker_exit.hpp"

namespace sluice {
namespace {

constexpr Standing kQueued{JobState::queued};
constexpr Standing kRunning{JobState::running};
constexpr Standing kPausing{JobState::running, PendingStop::pause};
constexpr Standing kCancelling{JobState::running, PendingStop::cancel};
constexpr Standing kPaused{JobState::paused};
constexpr Standing kCompleted{JobState::completed};
constexpr Standing kFailed{JobState::failed};
constexpr Standing kCancelled{JobState::cancelled};

// A cancel wins over a pause. What was asked for is obeyed however the attempt ends, unless it
// reached its own end first. Asking for what is so already changes nothing.
constexpr std::array kTransitions = {
    Transition{kQueued, Actor::scheduler, JobAction::claim, kRunning, "claimed"},

    Transition{kQueued, Actor::user, JobAction::pause, kPaused, "paused"},
    Transition{kQueued, Actor::user, JobAction::resume, kQueued, ""},
    Transition{kQueued, Actor::user, JobAction::cancel, kCancelled, "cancelled"},

    Transition{kRunning, Actor::user, JobAction::pause, kPausing, "pause_requested"},
    Transition{kRunning, Actor::user, JobAction::resume, kRunning, ""},
    Transition{kRunning, Actor::user, JobAction::cancel, kCancelling, "cancel_requested"},
    Transition{kRunning, Actor::attempt, JobAction::complete, kCompleted, "completed"},
    Transition{kRunning, Actor::attempt, JobAction::fail, kFailed, "failed"},
    Transition{kRunning, Actor::attempt, JobAction::requeue, kQueued, "requeued"},
    Transition{kRunning, Actor::attempt, JobAction::pause, kPaused, "paused"},
    Transition{kRunning, Actor::attempt, JobAction::release, kPaused, "paused"},
    Transition{kRunning, Actor::attempt, JobAction::cancel, kCancelled, "cancelled"},

    Transition{kPausing, Actor::user, JobAction::pause, kPausing, ""},
    Transition{kPausing, Actor::user, JobAction::resume, kRunning, "pause_withdrawn"},
    Transition{kPausing, Actor::user, JobAction::cancel, kCancelling, "cancel_requested"},
    Transition{kPausing, Actor::attempt, JobAction::complete, kCompleted, "completed"},
    Transition{kPausing, Actor::attempt, JobAction::fail, kFailed, "failed"},
    Transition{kPausing, Actor::attempt, JobAction::requeue, kPaused, "paused"},
    Transition{kPausing, Actor::attempt, JobAction::pause, kPaused, "paused"},
    Transition{kPausing, Actor::attempt, JobAction::release, kPaused, "paused"},
    Transition{kPausing, Actor::attempt, JobAction::cancel, kCancelled, "cancelled"},

    Transition{kCancelling, Actor::user, JobAction::pause, kCancelling, ""},
    Transition{kCancelling, Actor::user, JobAction::cancel, kCancelling, ""},
    Transition{kCancelling, Actor::attempt, JobAction::complete, kCompleted, "completed"},
    Transition{kCancelling, Actor::attempt, JobAction::fail, kFailed, "failed"},
    Transition{kCancelling, Actor::attempt, JobAction::requeue, kCancelled, "cancelled"},
    Transition{kCancelling, Actor::attempt, JobAction::pause, kCancelled, "cancelled"},
    Transition{kCancelling, Actor::attempt, JobAction::release, kCancelled, "cancelled"},
    Transition{kCancelling, Actor::attempt, JobAction::cancel, kCancelled, "cancelled"},

    Transition{kPaused, Actor::user, JobAction::pause, kPaused, ""},
    Transition{kPaused, Actor::user, JobAction::resume, kQueued, "resumed"},
    Transition{kPaused, Actor::user, JobAction::cancel, kCancelled, "cancelled"},

    Transition{kCompleted, Actor::user, JobAction::resume, kQueued, "extended", true},
    Transition{kFailed, Actor::user, JobAction::resume, kQueued, "extended", true},
    Transition{kCancelled, Actor::user, JobAction::resume, kQueued, "resumed"},
    Transition{kCancelled, Actor::user, JobAction::cancel, kCancelled, ""},
};

[[noreturn]] void refuse(const std::string& why) {
  throw JobStoreError(JobStoreError::Fault::conflict, why);
}

std::string describe(const Job& job) {
  const bool asked = job.pending_stop != PendingStop::none;
  return fmt::format("job {} is {}{}", job.id, to_string(job.state),
                     asked ? fmt::format(" and was asked to {}", to_string(job.pending_stop)) : "");
}

/// What ends a computation comes again, bit by bit, at the same step.
bool would_fail_again(const Job& job) {
  if (job.state != JobState::failed) return false;
  const auto outcome = stored_json(job.outcome);
  return outcome.is_object() && outcome.contains("exit_code") &&
         outcome["exit_code"] == WorkerExit::numerical_failure;
}

constexpr std::string_view kFailsAgain =
    "its computation would fail again at the same step, also with a later end time: submit a "
    "changed scene";

std::string advice(const Job& job, JobAction action) {
  if (action == JobAction::resume && job.pending_stop == PendingStop::cancel) {
    return "wait until it is cancelled, then resume it";
  }
  if (would_fail_again(job)) return "it has ended, and " + std::string(kFailsAgain);
  if (is_ended(job.state)) return "it has ended; resume it with a later end time";
  return "see the table of transitions in service/README.md";
}

/// A later end time makes sense only where a resume puts the job back into the queue.
void check_end_time(const Job& job, const Transition& transition, const JobChange& change) {
  const double wanted = change.end_time.value_or(job.end_time);
  if (wanted == job.end_time && !transition.needs_later_end) return;
  if (!(wanted > job.end_time) && would_fail_again(job)) {
    refuse(fmt::format("{}: {}", describe(job), kFailsAgain));
  }
  if (!(wanted > job.end_time)) {
    refuse(fmt::format("{} with end time {} s, and {} s is not later: give a later end time",
                       describe(job), job.end_time, wanted));
  }
  if (transition.event.empty() || transition.to != kQueued) {
    refuse(fmt::format("{}: its end time can be changed only when it is resumed; pause it first",
                       describe(job)));
  }
}

}  // namespace

std::span<const Transition> transitions() { return kTransitions; }

std::optional<Transition> find_transition(const Standing& from, Actor actor, JobAction action) {
  const auto found = std::find_if(kTransitions.begin(), kTransitions.end(), [&](const auto& row) {
    return row.from == from && row.actor == actor && row.action == action;
  });
  return found == kTransitions.end() ? std::nullopt : std::optional(*found);
}

Transition require_transition(const Job& job, JobAction action, const std::string& token,
                              const JobChange& change) {
  const Actor actor = token.empty() ? Actor::user : Actor::attempt;
  if (actor == Actor::attempt && (job.state != JobState::running || job.token != token)) {
    refuse(fmt::format("{}: the attempt that wants to {} it is no longer its running one",
                       describe(job), to_string(action)));
  }
  const auto transition = find_transition({job.state, job.pending_stop}, actor, action);
  if (!transition) {
    refuse(
        fmt::format("{}: cannot {} it; {}", describe(job), to_string(action), advice(job, action)));
  }
  check_end_time(job, *transition, change);
  return *transition;
}

namespace {

/// The last line of a worker is of up to a second before the end: that line, at the end.
std::string progress_at_end(const std::string& last, const std::string& outcome_text) {
  nlohmann::ordered_json progress = stored_json(last);
  const nlohmann::ordered_json outcome = stored_json(outcome_text);
  if (!progress.is_object() || !outcome.is_object()) return last;
  for (const char* const key : {"step", "time"}) {
    if (outcome.contains(key)) progress[key] = outcome[key];
  }
  progress["fraction"] = 1.0;
  progress["eta"] = 0.0;
  return progress.dump();
}

}  // namespace

Job after_transition(const Job& job, const Transition& transition, const JobChange& change,
                     std::int64_t now_ms) {
  Job after = job;
  after.state = transition.to.state;
  after.pending_stop = transition.to.pending;
  after.updated_ms = now_ms;
  after.ended_ms = is_ended(after.state) ? now_ms : 0;
  if (after.state != JobState::running) after.token.clear();
  if (transition.action == JobAction::resume) {
    after.reason.clear();
    after.crashes = 0;
  }
  if (change.reason) after.reason = *change.reason;
  if (change.outcome) after.outcome = *change.outcome;
  if (change.crashes) after.crashes = *change.crashes;
  if (change.end_time) after.end_time = *change.end_time;
  if (change.estimate) after.estimate = *change.estimate;
  if (after.state == JobState::completed) {
    after.progress = progress_at_end(job.progress, after.outcome);
  }
  return after;
}

}  // namespace sluice

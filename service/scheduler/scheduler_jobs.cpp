#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/store/disk/errors.hpp"
#include "service/http/problem.hpp"
#include "service/jobs/retention.hpp"
#include "service/jobs/service_log.hpp"
#include "service/scheduler/scheduler_loop.hpp"
#include "service/scheduler/worker_command.hpp"

// What the rounds of the scheduler's loop consist of; the rounds are in scheduler_loop.cpp.

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNextDeletion = 1.0;     // s between two lots of old jobs
constexpr double kLongestDeletion = 600;  // s between looks for old jobs
constexpr std::size_t kMostDeletions = 20;
/// Starts that the system may refuse a job in a row: two minutes of back-off.
constexpr int kMostRefusals = 8;

std::string detail_text(const Json& detail) {
  return detail.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

/// Whatever goes wrong with a job that is marked running: it is looked at again, by its folder.
template <class Action>
void SchedulerLoop::orphaned_on_error(const Job& job, const Action& action) {
  try {
    action();
  } catch (...) {
    orphans_.add(job, senses_.clock());
    throw;
  }
}

// --- what workers say and how they end

void SchedulerLoop::record(const Attempt& attempt, const std::vector<WorkerMessage>& messages) {
  for (const WorkerMessage& message : messages) {
    try {
      store_.record_event(attempt.job().id, message.event, message.detail);
    } catch (const JobStoreError& error) {
      log_scheduler(
          fmt::format("job {}: an event is not kept: {}", attempt.job().id, error.what()));
    }
  }
}

void SchedulerLoop::record_progress(Attempt& attempt) {
  const std::optional<std::string> progress = attempt.progress_due(senses_.clock());
  if (!progress) return;
  try {
    store_.record_progress(attempt.job().id, attempt.job().token, *progress);
  } catch (const JobStoreError& error) {
    log_scheduler(fmt::format("job {}: progress is not kept: {}", attempt.job().id, error.what()));
  }
}

void SchedulerLoop::finish(Attempt& attempt, const ProcessEnd& end) {
  orphaned_on_error(attempt.job(), [&] {
    AttemptFacts facts;
    facts.end = end;
    facts.cause = attempt.stop_cause();
    facts.outcome = attempt.outcome();
    facts.progressed = made_checkpoint(attempt.paths(), attempt.job());
    facts.crashes = attempt.job().crashes;
    facts.message = attempt.last_words();
    conclusions_.conclude(attempt.job(), judge(facts, limits_.crash_limit), senses_.clock());
  });
}

// --- jobs of the last service

void SchedulerLoop::recover() {
  JobFilter filter;
  filter.state = JobState::running;
  for (;;) {
    const std::vector<Job> page = store_.list(filter);
    for (const Job& job : page) orphans_.add(job, senses_.clock());
    if (page.size() < filter.limit) break;
    filter.after = page.back().id;
  }
  look_after_orphans();
}

void SchedulerLoop::look_after_orphans() {
  orphans_.look(senses_.clock(), [this](const Job& job) { conclude_orphan(job); });
}

/// What a worker left is all that is known of it.
void SchedulerLoop::conclude_orphan(const Job& job) {
  AttemptFacts facts;
  facts.outcome = fresh_outcome(paths(job), job);
  facts.progressed = made_checkpoint(paths(job), job);
  facts.crashes = job.crashes;
  AttemptVerdict verdict = judge(facts, limits_.crash_limit);
  verdict.next = NextTry::at_once;
  conclusions_.conclude(job, std::move(verdict), senses_.clock());
}

// --- limits

void SchedulerLoop::watch_disk() {
  disk_low_ = senses_.free_disk(data_) < limits_.disk_reserve;
  if (!disk_low_) return;
  for (Attempt& attempt : attempts_) attempt.stop(StopCause::disk_low, senses_.clock());
}

void SchedulerLoop::delete_old_jobs_when_due() {
  const double now = senses_.clock();
  if (!(limits_.retention_days > 0.0) || now < next_deletion_) return;
  const double kept = limits_.retention_days * 86400.0;
  const std::int64_t time = retention_.look(senses_.wall_ms(), now);
  if (const auto leap = retention_.new_leap()) {
    log_line(
        {{"event", "clock_leapt"},
         {"message",
          fmt::format("the clock is {:.1f} days ahead of the time that is known: if it says the "
                      "same in {:.1f} hours it is believed; until then no job is deleted for "
                      "that. Stop the service or set the clock if it is wrong",
                      *leap / 86400.0, retention_.grace() / 3600.0)}});
  }
  const auto limit = time - static_cast<std::int64_t>(std::min(kept, 1e9) * 1000.0);
  try {
    write_retention_time(data_, time);
  } catch (const StorageError& error) {
    log_scheduler(fmt::format("the time of this look is not kept: {}", error.what()));
  }
  const bool more = delete_old_jobs(store_, data_, limit, kMostDeletions) == kMostDeletions;
  next_deletion_ = now + (more ? kNextDeletion : std::clamp(kept, kNextDeletion, kLongestDeletion));
}

// --- starting

int SchedulerLoop::free_threads() const {
  int taken = orphans_.threads();
  for (const Attempt& attempt : attempts_) taken += attempt.job().threads;
  return std::max(0, cores_ - taken);
}

void SchedulerLoop::start_jobs() {
  if (board_.draining() || disk_low_ || !conclusions_.all_taken()) return;
  for (int free = free_threads(); free > 0; free = free_threads()) {
    const std::vector<std::string> except = conclusions_.back_offs().waiting(senses_.clock());
    if (head_waits_for_room(free, except)) return;
    const std::optional<Job> job = store_.claim(free, except);
    if (!job) return;
    bool started = false;
    orphaned_on_error(*job, [&] { started = start(*job); });
    if (!started) return;
  }
}

bool SchedulerLoop::head_waits_for_room(int free, const std::vector<std::string>& except) {
  if (free >= cores_) return false;
  const double now = senses_.clock();
  const std::optional<QueueView::Entry> head = queue_.first(cores_, except, now);
  if (head && head->threads > free) return patience_.is_over(head->id, now);
  patience_.forget();
  return false;
}

bool SchedulerLoop::start(const Job& job) {
  try {
    if (!JobFolder::holds_job(paths(job).root())) {
      AttemptVerdict verdict;
      verdict.action = JobAction::fail;
      verdict.change.reason = "its folder, or the scene in it, is gone";
      conclusions_.conclude(job, std::move(verdict), senses_.clock());
      return true;
    }
  } catch (const StorageError& error) {
    put_off(job, "its folder cannot be looked at: " + without_place(error.what(), data_));
    return true;
  }
  try {
    const std::filesystem::path folder = paths(job).root();
    const double now = senses_.clock();
    const Attempt& attempt = attempts_.emplace_back(
        job, folder, executor_.start(worker_command(worker_, folder, job, limits_)), now);
    const Json detail{{"pid", attempt.worker().pid()}, {"threads", job.threads}};
    record(attempt, {{"worker_started", detail_text(detail), {}, {}}});
    return true;
  } catch (const ProcessStartError& error) {
    put_off(job, fmt::format("cannot start a worker: {}", error.what()));
    return false;
  }
}

void SchedulerLoop::put_off(const Job& job, std::string reason) {
  AttemptVerdict verdict;
  const int refusals = conclusions_.back_offs().count(job.id, NextTry::after_refusal) + 1;
  if (refusals >= kMostRefusals) {
    verdict.action = JobAction::pause;
    reason += fmt::format("; tried {} times: mend this, then resume the job", refusals);
  }
  log_scheduler(fmt::format("job {}: {}", job.id, reason));
  verdict.change.event_detail = detail_text({{"reason", reason}});
  verdict.change.reason = std::move(reason);
  verdict.next = NextTry::after_refusal;
  conclusions_.conclude(job, std::move(verdict), senses_.clock());
}

}  // namespace sluice

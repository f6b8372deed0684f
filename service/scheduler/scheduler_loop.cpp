#include "service/scheduler/scheduler_loop.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "service/jobs/limits.hpp"
#include "service/jobs/service_log.hpp"
#include "service/scheduler/attempt_limits.hpp"

namespace sluice {
namespace {

constexpr double kDay = 86400.0;     // s
constexpr double kTick = 1.0;        // s
constexpr double kOrphanTick = 0.1;  // s: an orphan was told to stop and soon will
/// s that a drain waits for the store to take the last transitions. They are not lost without:
/// the next start makes them anew from the folders.
constexpr double kStorePatience = 5.0;

/// The newest time that is known from before this service, Unix time in ms; 0: none.
std::int64_t known_time(const JobStore& store, const std::filesystem::path& data) {
  const std::int64_t kept = read_retention_time(data);
  if (kept > 0) return kept;
  const auto newest = store.events("", store.last_event() - 1, 1);
  return newest.empty() ? 0 : newest.front().time_ms;
}

}  // namespace

SchedulerLoop::SchedulerLoop(JobStore& store, std::filesystem::path data, ServiceLimits limits,
                             const std::filesystem::path& worker, SchedulerSenses senses,
                             Executor& executor, const QueueView& queue, SchedulerBoard& board)
    : store_(store),
      data_(std::move(data)),
      limits_(limits),
      senses_(std::move(senses)),
      worker_(worker.empty() ? worker : std::filesystem::absolute(worker)),
      executor_(executor),
      queue_(queue),
      board_(board),
      cores_(thread_limit(limits)),
      orphans_(data_, limits.stop_seconds),
      conclusions_(store),
      retention_(limits.retention_days * kDay, known_time(store, data_)) {
  publish_status();
}

JobPaths SchedulerLoop::paths(const Job& job) const { return JobPaths(data_ / "jobs" / job.id); }

void SchedulerLoop::run() {
  const std::string missing = executor_.missing_confinement();
  if (limits_.confinement == Confinement::full && !missing.empty()) {
    log_scheduler(
        fmt::format("this system has no {}: workers are confined by limits alone", missing));
  }
  bool recovered = false;
  while (!drained()) {
    try {
      if (!std::exchange(recovered, true)) recover();
      one_round();
    } catch (const std::exception& error) {
      log_scheduler(fmt::format("the scheduler continues after an error: {}", error.what()));
      ::poll(nullptr, 0, static_cast<int>(1000 * kTick));
    }
  }
}

void SchedulerLoop::one_round() {
  wait();
  serve_workers();
  const bool ticking = senses_.clock() >= next_tick_;
  if (ticking) tick();
  if (std::exchange(look_, false) || ticking) {
    obey_requests();
    start_jobs();
  }
  publish_status();
}

bool SchedulerLoop::drained() const {
  if (draining_since_ <= 0.0 || !attempts_.empty()) return false;
  const double patience = limits_.stop_seconds + kStorePatience;
  return conclusions_.all_taken() || senses_.clock() - draining_since_ > patience;
}

void SchedulerLoop::wait() {
  std::vector<pollfd> entries{{board_.bell(), POLLIN, 0}};
  for (const Attempt& attempt : attempts_) {
    // Entries below 0 are passed over by poll.
    const RunningProcess& worker = attempt.worker();
    entries.push_back({worker.end_descriptor(), POLLIN, 0});
    entries.push_back({attempt.output_is_open() ? worker.output() : -1, POLLIN, 0});
    entries.push_back({attempt.errors_are_open() ? worker.errors() : -1, POLLIN, 0});
  }
  const double left = std::max(0.0, next_tick_ - senses_.clock());
  ::poll(entries.data(), entries.size(), static_cast<int>(std::ceil(1000 * left)));
  if (entries.front().revents != 0) {
    board_.hear();
    look_ = true;
  }
}

void SchedulerLoop::serve_workers() {
  for (auto attempt = attempts_.begin(); attempt != attempts_.end();) {
    const double now = senses_.clock();
    record(*attempt, attempt->read(now));
    record_progress(*attempt);
    const std::optional<ProcessEnd> end = attempt->end();
    if (!end) {
      ++attempt;
      continue;
    }
    record(*attempt, attempt->read(now));
    std::list<Attempt> ended;
    ended.splice(ended.begin(), attempts_, attempt++);
    look_ = true;
    finish(ended.front(), *end);
  }
}

void SchedulerLoop::obey_requests() {
  const std::set<std::string> checkpoints = board_.take_checkpoint_requests();
  const double now = senses_.clock();
  for (Attempt& attempt : attempts_) {
    if (board_.draining()) attempt.stop(StopCause::drain, now);
    const std::optional<Job> job = store_.find(attempt.job().id);
    if (job && job->pending_stop != PendingStop::none) attempt.stop(StopCause::asked, now);
    if (checkpoints.contains(attempt.job().id)) attempt.checkpoint();
  }
  if (board_.draining() && draining_since_ <= 0.0) draining_since_ = now;
}

void SchedulerLoop::tick() {
  conclusions_.retry();
  look_after_orphans();
  watch_disk();
  for (Attempt& attempt : attempts_) hold_to_limits(attempt, limits_, senses_);
  delete_old_jobs_when_due();
  next_tick_ = senses_.clock() + (orphans_.empty() ? kTick : kOrphanTick);
}

void SchedulerLoop::publish_status() {
  std::map<std::string, pid_t> workers;
  for (const Attempt& attempt : attempts_) {
    workers.emplace(attempt.job().id, attempt.worker().pid());
  }
  board_.publish({disk_low_, cores_, free_threads(), conclusions_.back_offs(), workers});
}

}  // namespace sluice

#include "service/scheduler_loop.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "service/admission.hpp"
#include "service/disk_guard.hpp"
#include "service/orphan.hpp"
#include "service/retention.hpp"
#include "service/scheduler_clock.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kTick = 1.0;             // s
constexpr double kOrphanTick = 0.1;       // s: an orphan was told to stop and soon will
constexpr double kDiskLook = 10.0;        // s between looks at how much the jobs take
constexpr double kLongestDeletion = 600;  // s between looks for old jobs
constexpr std::size_t kMostDeletions = 20;
/// s that a job may be passed over by smaller ones behind it before cores are kept for it.
constexpr double kPatience = 60.0;
/// s that a drain waits for the store to take the last transitions. They are not lost without:
/// the next start makes them anew from the folders.
constexpr double kStorePatience = 5.0;
/// Beyond what the limit counts: code, libraries, and per thread its stack and the heap's reserve.
constexpr std::uint64_t kFixedAddresses = std::uint64_t{1} << 30;
constexpr std::uint64_t kThreadAddresses = std::uint64_t{256} << 20;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // they reserve more addresses than there is memory
#else
constexpr bool kSanitized = false;
#endif

void log(std::string_view message) {
  std::fputs(fmt::format("sluice: {}\n", message).c_str(), stderr);
}

std::int64_t unix_ms() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
}

std::string detail_text(const Json& detail) {
  return detail.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool is_final(const JobStoreError& error) {
  return error.fault() == JobStoreError::Fault::conflict ||
         error.fault() == JobStoreError::Fault::not_found;
}

}  // namespace

SchedulerLoop::SchedulerLoop(JobStore& store, std::filesystem::path data, ServiceLimits limits,
                             const std::filesystem::path& worker, const QueueView& queue,
                             SchedulerBoard& board)
    : store_(store),
      data_(std::move(data)),
      limits_(limits),
      worker_(worker.empty() ? worker : std::filesystem::absolute(worker)),
      queue_(queue),
      board_(board),
      cores_(thread_limit(limits)) {
  publish_status();
}

JobPaths SchedulerLoop::paths(const Job& job) const { return JobPaths(data_ / "jobs" / job.id); }

/// Whatever goes wrong with a job that is marked running: it is looked at again, by its folder.
template <class Action>
void SchedulerLoop::orphaned_on_error(const Job& job, const Action& action) {
  try {
    action();
  } catch (...) {
    orphans_.push_back({job, scheduler_clock(), false});
    throw;
  }
}

// --- the rounds

void SchedulerLoop::run() {
  const std::string missing = Sandbox::missing();
  if (limits_.confinement == Confinement::full && !missing.empty()) {
    log(fmt::format("this system has no {}: workers are confined by limits alone", missing));
  }
  remove_deleted_folders(data_);
  bool recovered = false;
  while (!drained()) {
    try {
      if (!std::exchange(recovered, true)) recover();
      one_round();
    } catch (const std::exception& error) {
      log(fmt::format("the scheduler goes on after an error: {}", error.what()));
      ::poll(nullptr, 0, static_cast<int>(1000 * kTick));
    }
  }
}

void SchedulerLoop::one_round() {
  wait();
  serve_workers();
  const bool ticking = scheduler_clock() >= next_tick_;
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
  return ended_.empty() || scheduler_clock() - draining_since_ > patience;
}

void SchedulerLoop::wait() {
  std::vector<pollfd> entries{{board_.bell(), POLLIN, 0}};
  for (const Attempt& attempt : attempts_) {
    // Entries below 0 are passed over by poll.
    const WorkerProcess& process = attempt.process();
    entries.push_back({process.end_descriptor(), POLLIN, 0});
    entries.push_back({attempt.output_is_open() ? process.output() : -1, POLLIN, 0});
    entries.push_back({attempt.errors_are_open() ? process.errors() : -1, POLLIN, 0});
  }
  const double left = std::max(0.0, next_tick_ - scheduler_clock());
  ::poll(entries.data(), entries.size(), static_cast<int>(std::ceil(1000 * left)));
  if (entries.front().revents != 0) {
    board_.hear();
    look_ = true;
  }
}

void SchedulerLoop::serve_workers() {
  for (auto attempt = attempts_.begin(); attempt != attempts_.end();) {
    const double now = scheduler_clock();
    record(*attempt, attempt->read(now));
    record_progress(*attempt);
    const std::optional<WorkerEnd> end = attempt->end();
    if (!end) {
      ++attempt;
      continue;
    }
    record(*attempt, attempt->read(now));
    std::list<Attempt> ended;
    ended.splice(ended.begin(), attempts_, attempt++);
    look_ = true;
    orphaned_on_error(ended.front().job(), [&] { finish(ended.front(), *end); });
  }
}

void SchedulerLoop::obey_requests() {
  const std::set<std::string> checkpoints = board_.take_checkpoint_requests();
  const double now = scheduler_clock();
  for (Attempt& attempt : attempts_) {
    if (board_.draining()) attempt.stop(StopCause::drain, now);
    const std::optional<Job> job = store_.find(attempt.job().id);
    if (job && job->pending_stop != PendingStop::none) attempt.stop(StopCause::asked, now);
    if (checkpoints.contains(attempt.job().id)) attempt.checkpoint();
  }
  if (board_.draining() && draining_since_ <= 0.0) draining_since_ = now;
}

void SchedulerLoop::tick() {
  std::vector<Ended> waiting = std::exchange(ended_, {});
  for (Ended& ended : waiting) {
    if (!try_to_apply(ended)) ended_.push_back(std::move(ended));
  }
  look_after_orphans();
  watch_disk();
  for (Attempt& attempt : attempts_) watch(attempt);
  delete_old_jobs_when_due();
  next_tick_ = scheduler_clock() + (orphans_.empty() ? kTick : kOrphanTick);
}

void SchedulerLoop::publish_status() {
  board_.publish({disk_low_, cores_, free_threads(), back_offs_});
}

// --- what workers say and how they end

void SchedulerLoop::record(const Attempt& attempt, const std::vector<WorkerMessage>& messages) {
  for (const WorkerMessage& message : messages) {
    try {
      store_.record_event(attempt.job().id, message.event, message.detail);
    } catch (const JobStoreError& error) {
      log(fmt::format("job {}: an event is not kept: {}", attempt.job().id, error.what()));
    }
  }
}

void SchedulerLoop::record_progress(Attempt& attempt) {
  const std::optional<std::string> progress = attempt.progress_due(scheduler_clock());
  if (!progress) return;
  try {
    store_.record_progress(attempt.job().id, attempt.job().token, *progress);
  } catch (const JobStoreError& error) {
    log(fmt::format("job {}: progress is not kept: {}", attempt.job().id, error.what()));
  }
}

void SchedulerLoop::finish(Attempt& attempt, const WorkerEnd& end) {
  AttemptFacts facts;
  facts.end = end;
  facts.cause = attempt.stop_cause();
  facts.outcome = attempt.outcome();
  facts.progressed = made_checkpoint(attempt.paths(), attempt.job());
  facts.crashes = attempt.job().crashes;
  facts.message = attempt.last_words();
  conclude(attempt.job(), judge(facts, limits_.crash_limit));
}

void SchedulerLoop::conclude(const Job& job, AttemptVerdict verdict) {
  back_offs_.note(job.id, verdict.action == JobAction::requeue ? verdict.next : NextTry::at_once,
                  verdict.change.crashes.value_or(job.crashes), scheduler_clock());
  Ended ended{job, std::move(verdict)};
  if (!try_to_apply(ended)) ended_.push_back(std::move(ended));
}

bool SchedulerLoop::try_to_apply(const Ended& ended) {
  try {
    store_.apply(ended.job.id, ended.verdict.action, ended.job.token, ended.verdict.change);
    return true;
  } catch (const JobStoreError& error) {
    log(fmt::format("job {}: how its attempt ended is not kept{}: {}", ended.job.id,
                    is_final(error) ? "" : " yet", error.what()));
    return is_final(error);
  }
}

// --- jobs of the last service

void SchedulerLoop::recover() {
  JobFilter filter;
  filter.state = JobState::running;
  for (;;) {
    const std::vector<Job> page = store_.list(filter);
    for (const Job& job : page) orphans_.push_back({job, scheduler_clock(), false});
    if (page.size() < filter.limit) break;
    filter.after = page.back().id;
  }
  look_after_orphans();
}

void SchedulerLoop::look_after_orphans() {
  for (auto orphan = orphans_.begin(); orphan != orphans_.end();) {
    if (!is_in_use(paths(orphan->job))) {
      conclude_orphan(orphan->job);
      orphan = orphans_.erase(orphan);
      continue;
    }
    const bool late = scheduler_clock() - orphan->since > limits_.stop_seconds;
    if (late && !std::exchange(orphan->killed, true)) {
      const bool ours = kill_orphan(paths(orphan->job), orphan->job.token);
      log(fmt::format("job {}: {}", orphan->job.id,
                      ours ? "a worker of the last service did not stop and was killed"
                           : "another process uses its folder; it goes on when that ends"));
    }
    ++orphan;
  }
}

/// What a worker left is all that is known of it.
void SchedulerLoop::conclude_orphan(const Job& job) {
  AttemptFacts facts;
  facts.outcome = fresh_outcome(paths(job), job);
  facts.progressed = made_checkpoint(paths(job), job);
  facts.crashes = job.crashes;
  AttemptVerdict verdict = judge(facts, limits_.crash_limit);
  verdict.next = NextTry::at_once;
  conclude(job, std::move(verdict));
}

// --- limits

void SchedulerLoop::watch_disk() {
  disk_low_ = free_disk(data_) < limits_.disk_reserve;
  if (!disk_low_) return;
  for (Attempt& attempt : attempts_) attempt.stop(StopCause::disk_low, scheduler_clock());
}

void SchedulerLoop::watch(Attempt& attempt) {
  const double now = scheduler_clock();
  if (attempt.stop_cause() != StopCause::none) {
    if (attempt.stopping_for(now) > limits_.stop_seconds) attempt.kill(attempt.stop_cause());
    return;
  }
  if (attempt.stalled_for(now) > limits_.stalled_seconds) return attempt.kill(StopCause::stalled);
  const double longest = limits_.wall_seconds_per_attempt;
  if (longest > 0.0 && attempt.age(now) > longest) attempt.stop(StopCause::wall_limit, now);
  watch_job_disk(attempt);
}

void SchedulerLoop::watch_job_disk(Attempt& attempt) {
  const double now = scheduler_clock();
  if (limits_.disk_per_job == 0 || !attempt.disk_look_due(now, kDiskLook)) return;
  if (used_disk(attempt.paths().root()) > limits_.disk_per_job) {
    attempt.stop(StopCause::disk_limit, now);
  }
}

void SchedulerLoop::delete_old_jobs_when_due() {
  const double now = scheduler_clock();
  if (!(limits_.retention_days > 0.0) || now < next_deletion_) return;
  const double kept = limits_.retention_days * 86400.0;
  const auto limit = unix_ms() - static_cast<std::int64_t>(std::min(kept, 1e9) * 1000.0);
  const bool more = delete_old_jobs(store_, data_, limit, kMostDeletions) == kMostDeletions;
  next_deletion_ = now + (more ? kTick : std::clamp(kept, kTick, kLongestDeletion));
}

// --- starting

int SchedulerLoop::free_threads() const {
  int taken = 0;
  for (const Attempt& attempt : attempts_) taken += attempt.job().threads;
  for (const Orphan& orphan : orphans_) taken += orphan.job.threads;
  return std::max(0, cores_ - taken);
}

void SchedulerLoop::start_jobs() {
  if (board_.draining() || disk_low_ || !ended_.empty()) return;
  for (int free = free_threads(); free > 0; free = free_threads()) {
    const std::vector<std::string> except = back_offs_.waiting(scheduler_clock());
    if (head_waits_for_room(free, except)) return;
    const std::optional<Job> job = store_.claim(free, except);
    if (!job) return;
    orphaned_on_error(*job, [&] { start(*job); });
  }
}

/// A job that needs many cores would wait for ever behind small ones that slip past it.
bool SchedulerLoop::head_waits_for_room(int free, const std::vector<std::string>& except) {
  if (free >= cores_) return false;
  const double now = scheduler_clock();
  const std::optional<QueueView::Entry> head = queue_.first(cores_, except, now);
  if (!head || head->threads <= free) {
    passed_over_.clear();
    return false;
  }
  if (head->id != passed_over_) {
    passed_over_ = head->id;
    passed_over_since_ = now;
  }
  return now - passed_over_since_ > kPatience;
}

WorkerCommand SchedulerLoop::command_for(const Job& job) const {
  WorkerCommand command;
  command.program = worker_;
  command.folder = paths(job).root();
  command.arguments = {"run",        command.folder.string(),
                       "--threads",  std::to_string(job.threads),
                       "--progress", "json"};
  command.token = job.token;
  if (!kSanitized) {
    command.address_space = memory_limit(limits_) + kFixedAddresses +
                            static_cast<std::uint64_t>(job.threads) * kThreadAddresses;
  }
  command.largest_file = limits_.disk_per_job;
  command.confinement = limits_.confinement;
  return command;
}

void SchedulerLoop::start(const Job& job) {
  AttemptVerdict verdict;
  if (!JobFolder::holds_job(paths(job).root())) {
    verdict.action = JobAction::fail;
    verdict.change.reason = "its folder, or the scene in it, is gone";
    return conclude(job, std::move(verdict));
  }
  try {
    const Attempt& attempt = attempts_.emplace_back(job, command_for(job), scheduler_clock());
    const Json detail{{"pid", attempt.process().pid()}, {"threads", job.threads}};
    record(attempt, {{"worker_started", detail_text(detail), {}, {}}});
  } catch (const WorkerStartError& error) {
    verdict.action = JobAction::requeue;
    verdict.change.reason = error.what();
    verdict.change.event_detail = detail_text({{"reason", error.what()}});
    verdict.next = NextTry::after_lock;
    conclude(job, std::move(verdict));
  }
}

}  // namespace sluice

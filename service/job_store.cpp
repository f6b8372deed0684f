#include "service/job_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>

#include "engine/store/errors.hpp"
#include "service/data_lock.hpp"
#include "service/job_file.hpp"
#include "service/job_ids.hpp"
#include "service/job_rows.hpp"
#include "service/migrate.hpp"
#include "service/sqlite_db.hpp"
#include "service/transitions.hpp"

namespace sluice {
namespace {

using Fault = JobStoreError::Fault;
using Lock = std::unique_lock<std::mutex>;

/// Longer than any caller waits; keeps infinities and NaN from the clock.
constexpr double kLongestWait = 3600.0;  // s

[[noreturn]] void fail_not_found(const std::string& id) {
  throw JobStoreError(Fault::not_found, fmt::format("there is no job {}", id));
}

Job require_job(SqliteDb& db, const std::string& id) {
  std::optional<Job> job = select_job(db, id);
  if (!job) fail_not_found(id);
  return *std::move(job);
}

/// The job that `key` made, if it made one.
std::optional<Job> job_of_key(SqliteDb& db, const std::string& key, const std::string& body_hash) {
  if (key.empty()) return std::nullopt;
  const std::optional<KeyRow> row = select_key(db, key);
  if (!row) return std::nullopt;
  if (row->body_hash != body_hash) {
    throw JobStoreError(Fault::key_reused,
                        fmt::format("this Idempotency-Key came with another body before and made "
                                    "job {}; take a new key for a new job",
                                    row->job));
  }
  return require_job(db, row->job);
}

void require_room(SqliteDb& db, std::size_t limit) {
  const auto queued =
      static_cast<std::size_t>(db.number("SELECT count(*) FROM jobs WHERE state = 'queued'"));
  if (queued >= limit) {
    throw JobStoreError(Fault::full,
                        fmt::format("{} jobs are queued, and {} may be: try again when "
                                    "some have run",
                                    queued, limit));
  }
}

/// What a submitted job may bring along; all else begins from nothing.
Job fresh_job(const Job& wanted, std::string id, std::int64_t now_ms) {
  Job job;
  job.id = std::move(id);
  job.name = wanted.name;
  job.label = wanted.label;
  job.priority = wanted.priority;
  job.threads = wanted.threads;
  job.scene_hash = wanted.scene_hash;
  job.end_time = wanted.end_time;
  job.estimate = wanted.estimate;
  job.reason = wanted.reason;
  job.created_ms = wanted.created_ms > 0 ? wanted.created_ms : now_ms;
  job.updated_ms = now_ms;
  return job;
}

std::optional<JobState> held(JobState state) {
  const bool is_held = state == JobState::paused || state == JobState::cancelled;
  return is_held ? std::optional(state) : std::nullopt;
}

}  // namespace

class JobStore::Impl {
 public:
  explicit Impl(const std::filesystem::path& data)
      : data_(data), lock_(data), db_(data / "jobs.sqlite") {
    prepare_database(db_, lock_.last_stop());
    ids_.follow(db_.text("SELECT max(id) FROM jobs"));
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (!db_.found_damage()) lock_.note_clean_stop();
  }

  [[nodiscard]] Lock hold() { return Lock(mutex_); }
  SqliteDb& db() { return db_; }

  std::string new_id() { return ids_.next(unix_time_ms()); }

  /// Adds an event in the open transaction, commits it and wakes those who wait for events.
  void commit_with_event(SqliteTransaction& transaction, const JobEvent& event) {
    insert_event(db_, event);
    transaction.commit();
    changed_.notify_all();
  }

  void wake() {
    const Lock lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
  }
  void notify() { changed_.notify_all(); }

  void wait_for_event(const std::string& id, std::int64_t after, double seconds) {
    const double bounded = seconds > 0.0 ? std::min(seconds, kLongestWait) : 0.0;
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(bounded);
    Lock lock(mutex_);
    changed_.wait_until(lock, std::chrono::time_point_cast<std::chrono::nanoseconds>(end), [&] {
      return stopping_ || has_event(db_, id, after) || (!id.empty() && !select_job(db_, id));
    });
  }

  /// Notes in the job's folder that a person holds it, so that a rebuilt row does not run unasked.
  /// The row counts: a folder that cannot be written is left as it is.
  void note_in_folder(const Job& before, const Job& after) const {
    if (held(before.state) == held(after.state) || !is_job_id(after.id)) return;
    try {
      note_held(data_ / "jobs" / after.id, held(after.state));
    } catch (const StorageError&) {
    }
  }

 private:
  std::filesystem::path data_;
  DataLock lock_;
  SqliteDb db_;
  JobIds ids_;
  std::mutex mutex_;  ///< guards all but data_ and lock_
  std::condition_variable changed_;
  bool stopping_ = false;
};

JobStore::JobStore(const std::filesystem::path& data) : impl_(std::make_unique<Impl>(data)) {}
JobStore::~JobStore() = default;

std::string JobStore::new_id() {
  const Lock lock = impl_->hold();
  return impl_->new_id();
}

JobStore::Submitted JobStore::submit(const Job& job, const std::string& key,
                                     const std::string& body_hash, std::size_t limit) {
  const Lock lock = impl_->hold();
  SqliteDb& db = impl_->db();
  SqliteTransaction transaction(db);
  if (std::optional<Job> known = job_of_key(db, key, body_hash)) return {*std::move(known), true};
  require_room(db, limit);
  Job added = fresh_job(job, job.id.empty() ? impl_->new_id() : job.id, unix_time_ms());
  insert_job(db, added);
  if (!key.empty()) insert_key(db, key, {added.id, body_hash});
  impl_->commit_with_event(transaction, {0, added.id, added.updated_ms, "submitted", "{}"});
  return {std::move(added), false};
}

std::optional<Job> JobStore::find_by_key(const std::string& key,
                                         const std::string& body_hash) const {
  const Lock lock = impl_->hold();
  return job_of_key(impl_->db(), key, body_hash);
}

std::optional<Job> JobStore::find(const std::string& id) const {
  const Lock lock = impl_->hold();
  return select_job(impl_->db(), id);
}

std::vector<Job> JobStore::list(const JobFilter& filter) const {
  const Lock lock = impl_->hold();
  return select_jobs(impl_->db(), filter);
}

std::vector<std::pair<JobState, std::size_t>> JobStore::count_by_state() const {
  const Lock lock = impl_->hold();
  std::vector<std::pair<JobState, std::size_t>> counts;
  for (const JobState state : {JobState::queued, JobState::running, JobState::paused,
                               JobState::completed, JobState::failed, JobState::cancelled}) {
    SqliteStatement count(impl_->db(), "SELECT count(*) FROM jobs WHERE state = ?1",
                          to_string(state));
    counts.emplace_back(state, count.step() ? static_cast<std::size_t>(count.integer(0)) : 0);
  }
  return counts;
}

std::optional<Job> JobStore::claim(int threads, const std::vector<std::string>& except) {
  const std::string passed_over =
      nlohmann::json(except).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  const Lock lock = impl_->hold();
  SqliteTransaction transaction(impl_->db());
  std::optional<Job> job =
      claim_job(impl_->db(), threads, passed_over, random_token(), unix_time_ms());
  if (!job) return std::nullopt;
  const std::string detail = fmt::format("{{\"attempt\":{}}}", job->attempts);
  impl_->commit_with_event(transaction, {0, job->id, job->updated_ms, "claimed", detail});
  return job;
}

Job JobStore::apply(const std::string& id, JobAction action, const std::string& token,
                    const JobChange& change) {
  const Lock lock = impl_->hold();
  SqliteDb& db = impl_->db();
  SqliteTransaction transaction(db);
  Job before = require_job(db, id);
  const Transition transition = require_transition(before, action, token, change);
  if (transition.event.empty()) return before;
  Job after = after_transition(before, transition, change, unix_time_ms());
  if (!update_job(db, before, after)) {
    throw JobStoreError(Fault::conflict, fmt::format("job {} was changed meanwhile", id));
  }
  impl_->commit_with_event(
      transaction, {0, id, after.updated_ms, std::string(transition.event), change.event_detail});
  impl_->note_in_folder(before, after);
  return after;
}

void JobStore::record_progress(const std::string& id, const std::string& token,
                               const std::string& progress) {
  const Lock lock = impl_->hold();
  SqliteTransaction transaction(impl_->db());
  SqliteStatement(impl_->db(),
                  "UPDATE jobs SET progress = ?1, updated_ms = ?2 "
                  "WHERE id = ?3 AND state = 'running' AND token = ?4",
                  progress, unix_time_ms(), id, token)
      .run();
  if (impl_->db().changes() != 1) {
    (void)require_job(impl_->db(), id);
    throw JobStoreError(Fault::conflict,
                        fmt::format("job {}: progress of an attempt that is no longer its running "
                                    "one",
                                    id));
  }
  transaction.commit();
}

void JobStore::record_event(const std::string& id, const std::string& name,
                            const std::string& detail) {
  const Lock lock = impl_->hold();
  SqliteTransaction transaction(impl_->db());
  (void)require_job(impl_->db(), id);
  impl_->commit_with_event(transaction, {0, id, unix_time_ms(), name, detail});
}

void JobStore::remove(const std::string& id) {
  const Lock lock = impl_->hold();
  SqliteTransaction transaction(impl_->db());
  const Job job = require_job(impl_->db(), id);
  if (!is_ended(job.state)) {
    throw JobStoreError(Fault::conflict, fmt::format("job {} is {}: cancel it before it is deleted",
                                                     id, to_string(job.state)));
  }
  SqliteStatement(impl_->db(), "DELETE FROM jobs WHERE id = ?1", id).run();
  transaction.commit();
  impl_->notify();
}

std::vector<JobEvent> JobStore::events(const std::string& id, std::int64_t after,
                                       std::size_t limit) const {
  const Lock lock = impl_->hold();
  return select_events(impl_->db(), id, after, limit);
}

void JobStore::wait_for_event(const std::string& id, std::int64_t after, double seconds) const {
  impl_->wait_for_event(id, after, seconds);
}

std::int64_t JobStore::last_event() const {
  const Lock lock = impl_->hold();
  return impl_->db().number("SELECT seq FROM sqlite_sequence WHERE name = 'events'");
}

void JobStore::wake() { impl_->wake(); }

bool JobStore::adopt(const Job& job, const std::string& key, const std::string& body_hash) {
  const Lock lock = impl_->hold();
  SqliteDb& db = impl_->db();
  SqliteTransaction transaction(db);
  if (select_job(db, job.id)) return false;
  if (!key.empty()) {
    if (const std::optional<KeyRow> row = select_key(db, key)) {
      throw JobStoreError(Fault::key_reused,
                          fmt::format("job {} has the same Idempotency-Key", row->job));
    }
  }
  insert_job(db, job);
  if (!key.empty()) insert_key(db, key, {job.id, body_hash});
  impl_->commit_with_event(transaction, {0, job.id, unix_time_ms(), "adopted", "{}"});
  return true;
}

}  // namespace sluice

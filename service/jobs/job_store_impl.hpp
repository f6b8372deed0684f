#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "service/jobs/data_lock.hpp"
#include "service/jobs/job_ids.hpp"
#include "service/jobs/job_rows.hpp"
#include "service/jobs/job_store.hpp"
#include "service/jobs/live_progress.hpp"
#include "service/jobs/sqlite_db.hpp"

namespace sluice {

/// What the members of JobStore share: one connection, used under one mutex. The mutex is held over
/// a write's way to the disk, a few ms, so that rows, events and job.json have one order.
class JobStore::Impl {
 public:
  using Lock = std::unique_lock<std::mutex>;

  explicit Impl(const std::filesystem::path& data);
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();

  // All that follows but trouble, wait_for_event and wake is called with the lock held.
  [[nodiscard]] Lock hold() { return Lock(mutex_); }
  [[nodiscard]] SqliteDb& db() { return db_; }
  [[nodiscard]] LiveProgress& progress() { return progress_; }
  [[nodiscard]] std::string new_id();
  /// With its newest progress. Throws not_found.
  [[nodiscard]] Job require_job(const std::string& id);
  /// The job that `key` made, if it made one. Throws key_reused.
  [[nodiscard]] std::optional<Job> job_of_key(const std::string& key, const std::string& body_hash);
  /// Adds an event in the open transaction, commits it and wakes those who wait for events.
  void commit_with_event(SqliteTransaction& transaction, const JobEvent& event);
  /// Notes in the job's folder that a person holds it, so that a rebuilt row does not run unasked.
  /// The row counts: a folder that cannot be written is left as it is.
  void note_in_folder(const Job& before, const Job& after) const;
  void notify() { changed_.notify_all(); }

  [[nodiscard]] std::string trouble() const { return lock_.trouble(); }
  void wait_for_event(const std::string& id, std::int64_t after, double seconds);
  void wake();

 private:
  std::filesystem::path data_;
  DataLock lock_;
  SqliteDb db_;
  JobIds ids_;
  LiveProgress progress_;
  std::mutex mutex_;  ///< guards all but data_ and lock_
  std::condition_variable changed_;
  bool stopping_ = false;
};

}  // namespace sluice

#include "service/jobs/job_store_impl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "engine/store/disk/errors.hpp"
#include "service/jobs/job_file.hpp"
#include "service/jobs/migrate.hpp"

namespace sluice {
namespace {

using Fault = JobStoreError::Fault;

/// Longer than any caller waits; keeps infinities and NaN from the clock.
constexpr double kLongestWait = 3600.0;  // s

/// One more than a passing error of the disk needs. What lasts longer, the next start mends.
constexpr int kNoteTries = 2;

}  // namespace

JobStore::Impl::Impl(const std::filesystem::path& data)
    : data_(data), lock_(data), db_(data / "jobs.sqlite") {
  prepare_database(db_, lock_.last_stop());
  ids_.follow(db_.text("SELECT max(id) FROM jobs"));
}

JobStore::Impl::~Impl() {
  if (!db_.found_damage()) lock_.note_clean_stop();
}

std::string JobStore::Impl::new_id() { return ids_.next(unix_time_ms()); }

Job JobStore::Impl::require_job(const std::string& id) {
  std::optional<Job> job = select_job(db_, id);
  if (!job) throw JobStoreError(Fault::not_found, fmt::format("there is no job {}", id));
  progress_.show_in(*job);
  return *std::move(job);
}

std::optional<Job> JobStore::Impl::job_of_key(const std::string& key,
                                              const std::string& body_hash) {
  if (key.empty()) return std::nullopt;
  const std::optional<KeyRow> row = select_key(db_, key);
  if (!row) return std::nullopt;
  if (row->body_hash != body_hash) {
    throw JobStoreError(Fault::key_reused,
                        fmt::format("this Idempotency-Key came with another request before (body, "
                                    "label, priority or threads differ) and made "
                                    "job {}; take a new key for a new job",
                                    row->job));
  }
  return require_job(row->job);
}

void JobStore::Impl::commit_with_event(SqliteTransaction& transaction, const JobEvent& event) {
  insert_event(db_, event);
  transaction.commit();
  changed_.notify_all();
}

void JobStore::Impl::note_in_folder(const Job& before, const Job& after) const {
  if (held_in(before.state) == held_in(after.state) || !is_job_id(after.id)) return;
  for (int n = 0; n < kNoteTries; ++n) {
    try {
      return note_held(data_ / "jobs" / after.id, held_in(after.state));
    } catch (const StorageError&) {
    }
  }
}

void JobStore::Impl::wait_for_event(const std::string& id, std::int64_t after, double seconds) {
  const double bounded = seconds > 0.0 ? std::min(seconds, kLongestWait) : 0.0;
  const auto end = std::chrono::steady_clock::now() +
                   std::chrono::milliseconds(static_cast<std::int64_t>(1000.0 * bounded + 0.5));
  Lock lock(mutex_);
  changed_.wait_until(lock, end, [&] {
    return stopping_ || has_event(db_, id, after) || (!id.empty() && !select_job(db_, id));
  });
}

void JobStore::Impl::wake() {
  const Lock lock(mutex_);
  stopping_ = true;
  changed_.notify_all();
}

}  // namespace sluice

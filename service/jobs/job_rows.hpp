#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/jobs/job_store.hpp"
#include "service/jobs/sqlite_db.hpp"

// Rows of schemas/sql as plain data. No rules here; transactions are the caller's.

namespace sluice {

/// Columns of `jobs` in the order in which read_job() takes them.
[[nodiscard]] std::string_view job_columns();
[[nodiscard]] Job read_job(const SqliteStatement& row);

[[nodiscard]] std::optional<Job> select_job(SqliteDb& db, const std::string& id);
[[nodiscard]] std::vector<Job> select_jobs(SqliteDb& db, const JobFilter& filter);
void insert_job(SqliteDb& db, const Job& job);
/// Writes what a transition changes, if the row still stands where `before` does; else false.
[[nodiscard]] bool update_job(SqliteDb& db, const Job& before, const Job& after);
/// The queued job with the highest priority, then age, that needs at most `threads` and is not in
/// `except`, a JSON array of ids: marked as running with `token` by one statement.
[[nodiscard]] std::optional<Job> claim_job(SqliteDb& db, int threads, const std::string& except,
                                           const std::string& token, std::int64_t now_ms);

void insert_event(SqliteDb& db, const JobEvent& event);
[[nodiscard]] std::vector<JobEvent> select_events(SqliteDb& db, const std::string& job,
                                                  std::int64_t after, std::size_t limit);
[[nodiscard]] bool has_event(SqliteDb& db, const std::string& job, std::int64_t after);

/// A known Idempotency-Key: the job that it made and the hash of its body.
struct KeyRow {
  std::string job;
  std::string body_hash;
};
[[nodiscard]] std::optional<KeyRow> select_key(SqliteDb& db, const std::string& key);
void insert_key(SqliteDb& db, const std::string& key, const KeyRow& row);

}  // namespace sluice

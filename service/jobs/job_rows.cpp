#include "service/jobs/job_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace sluice {
namespace {

using Fault = JobStoreError::Fault;

/// The file holds only words of ours, by its own checks.
template <class Word>
Word known(const std::optional<Word>& word, std::string_view text) {
  if (!word)
    throw JobStoreError(Fault::damaged, fmt::format("jobs.sqlite: no such word: {}", text));
  return *word;
}

std::int64_t row_count(std::size_t limit) {
  constexpr auto kLargest = static_cast<std::size_t>(std::numeric_limits<std::int64_t>::max());
  return static_cast<std::int64_t>(std::min(limit, kLargest));
}

JobEvent read_event(const SqliteStatement& row) {
  return {row.integer(0), row.text(1), row.integer(2), row.text(3), row.text(4)};
}

}  // namespace

std::string_view job_columns() {
  return "id, state, pending_stop, name, label, priority, threads, created_ms, updated_ms, "
         "started_ms, ended_ms, token, attempts, crashes, reason, scene_hash, end_time, estimate, "
         "progress, outcome";
}

Job read_job(const SqliteStatement& row) {
  Job job;
  int column = 0;
  const auto text = [&] { return row.text(column++); };
  const auto integer = [&] { return row.integer(column++); };
  const auto small = [&] { return static_cast<int>(row.integer(column++)); };
  job.id = text();
  const std::string state = text();
  job.state = known(job_state(state), state);
  const std::string pending = text();
  job.pending_stop = known(pending_stop(pending), pending);
  job.name = text();
  job.label = text();
  job.priority = small();
  job.threads = small();
  job.created_ms = integer();
  job.updated_ms = integer();
  job.started_ms = integer();
  job.ended_ms = integer();
  job.token = text();
  job.attempts = small();
  job.crashes = small();
  job.reason = text();
  job.scene_hash = text();
  job.end_time = row.real(column++);
  job.estimate = text();
  job.progress = text();
  job.outcome = text();
  return job;
}

std::optional<Job> select_job(SqliteDb& db, const std::string& id) {
  SqliteStatement select(db, fmt::format("SELECT {} FROM jobs WHERE id = ?1", job_columns()), id);
  return select.step() ? std::optional(read_job(select)) : std::nullopt;
}

std::vector<Job> select_jobs(SqliteDb& db, const JobFilter& filter) {
  std::string where = "id < ?1";
  if (filter.state) where += fmt::format(" AND state = '{}'", to_string(*filter.state));
  if (filter.label) where += " AND label = ?3";
  SqliteStatement select(db, fmt::format("SELECT {} FROM jobs WHERE {} ORDER BY id DESC LIMIT ?2",
                                         job_columns(), where));
  constexpr std::string_view kAfterAllIds = "~";
  select.bind(filter.after.empty() ? kAfterAllIds : std::string_view(filter.after));
  select.bind(row_count(filter.limit));
  if (filter.label) select.bind(*filter.label);
  std::vector<Job> jobs;
  while (select.step()) jobs.push_back(read_job(select));
  return jobs;
}

void insert_job(SqliteDb& db, const Job& job) {
  SqliteStatement(db,
                  fmt::format("INSERT INTO jobs ({}) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, "
                              "?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17, ?18, ?19, ?20)",
                              job_columns()),
                  job.id, to_string(job.state), to_string(job.pending_stop), job.name, job.label,
                  job.priority, job.threads, job.created_ms, job.updated_ms, job.started_ms,
                  job.ended_ms, job.token, job.attempts, job.crashes, job.reason, job.scene_hash,
                  job.end_time, job.estimate, job.progress, job.outcome)
      .run();
}

bool update_job(SqliteDb& db, const Job& before, const Job& after) {
  SqliteStatement(db,
                  "UPDATE jobs SET state = ?1, pending_stop = ?2, updated_ms = ?3, ended_ms = ?4, "
                  "token = ?5, crashes = ?6, reason = ?7, end_time = ?8, progress = ?9, "
                  "outcome = ?10, estimate = ?11 "
                  "WHERE id = ?12 AND state = ?13 AND pending_stop = ?14 AND token = ?15",
                  to_string(after.state), to_string(after.pending_stop), after.updated_ms,
                  after.ended_ms, after.token, after.crashes, after.reason, after.end_time,
                  after.progress, after.outcome, after.estimate, before.id, to_string(before.state),
                  to_string(before.pending_stop), before.token)
      .run();
  return db.changes() == 1;
}

std::optional<Job> claim_job(SqliteDb& db, int threads, const std::string& except,
                             const std::string& token, std::int64_t now_ms) {
  SqliteStatement claim(
      db,
      fmt::format("UPDATE jobs SET state = 'running', token = ?1, attempts = attempts + 1, "
                  "started_ms = ?2, updated_ms = ?2, reason = '' WHERE id = "
                  "(SELECT id FROM jobs INDEXED BY jobs_in_queue WHERE state = 'queued' AND "
                  "threads <= ?3 AND id NOT IN "
                  "(SELECT value FROM json_each(?4)) ORDER BY priority DESC, id LIMIT 1) "
                  "RETURNING {}",
                  job_columns()),
      token, now_ms, threads, except);
  if (!claim.step()) return std::nullopt;
  Job job = read_job(claim);
  claim.run();
  return job;
}

void insert_event(SqliteDb& db, const JobEvent& event) {
  SqliteStatement(db, "INSERT INTO events (job, time_ms, name, detail) VALUES (?1, ?2, ?3, ?4)",
                  event.job, event.time_ms, event.name, event.detail)
      .run();
}

std::vector<JobEvent> select_events(SqliteDb& db, const std::string& job, std::int64_t after,
                                    std::size_t limit) {
  SqliteStatement select(db,
                         fmt::format("SELECT number, job, time_ms, name, detail FROM events WHERE "
                                     "number > ?1 {} ORDER BY number LIMIT ?2",
                                     job.empty() ? "" : "AND job = ?3"),
                         after, row_count(limit));
  if (!job.empty()) select.bind(job);
  std::vector<JobEvent> events;
  while (select.step()) events.push_back(read_event(select));
  return events;
}

bool has_event(SqliteDb& db, const std::string& job, std::int64_t after) {
  return !select_events(db, job, after, 1).empty();
}

std::optional<KeyRow> select_key(SqliteDb& db, const std::string& key) {
  SqliteStatement select(db, "SELECT job, body_hash FROM idempotency_keys WHERE key = ?1", key);
  return select.step() ? std::optional(KeyRow{select.text(0), select.text(1)}) : std::nullopt;
}

void insert_key(SqliteDb& db, const std::string& key, const KeyRow& row) {
  SqliteStatement(db, "INSERT INTO idempotency_keys (key, body_hash, job) VALUES (?1, ?2, ?3)", key,
                  row.body_hash, row.job)
      .run();
}

}  // namespace sluice

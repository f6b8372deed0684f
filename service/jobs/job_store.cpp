#include "service/jobs/job_store.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "service/jobs/job_store_impl.hpp"
#include "service/jobs/transitions.hpp"

namespace sluice {
namespace {

using Fault = JobStoreError::Fault;

void require_room(SqliteDb& db, std::size_t wanted, std::size_t limit) {
  const auto queued =
      static_cast<std::size_t>(db.number("SELECT count(*) FROM jobs WHERE state = 'queued'"));
  if (queued + wanted <= limit) return;
  const std::string more = wanted == 1 ? "" : fmt::format(", and {} more do not fit", wanted);
  throw JobStoreError(Fault::full,
                      fmt::format("{} jobs are queued, and {} may be{}: try again when "
                                  "some have run",
                                  queued, limit, more));
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

Job ended(Job job) {
  if (is_ended(job.state)) return job;
  throw JobStoreError(Fault::conflict,
                      fmt::format("job {} is {}: only a job that has ended can be deleted; cancel "
                                  "it first",
                                  job.id, to_string(job.state)));
}

}  // namespace

JobStore::JobStore(const std::filesystem::path& data) : impl_(std::make_unique<Impl>(data)) {}
JobStore::~JobStore() = default;

std::string JobStore::new_id() {
  const Impl::Lock lock = impl_->hold();
  return impl_->new_id();
}

JobStore::Submitted JobStore::submit(const Job& job, const std::string& key,
                                     const std::string& body_hash, std::size_t limit) {
  const Impl::Lock lock = impl_->hold();
  SqliteDb& db = impl_->db();
  SqliteTransaction transaction(db);
  if (std::optional<Job> known = impl_->job_of_key(key, body_hash))
    return {*std::move(known), true};
  require_room(db, 1, limit);
  Job added = fresh_job(job, job.id.empty() ? impl_->new_id() : job.id, unix_time_ms());
  insert_job(db, added);
  if (!key.empty()) insert_key(db, key, {added.id, body_hash});
  impl_->commit_with_event(transaction, {0, added.id, added.updated_ms, "submitted", "{}"});
  return {std::move(added), false};
}

std::vector<Job> JobStore::submit_all(const std::vector<Job>& jobs, std::size_t limit) {
  const Impl::Lock lock = impl_->hold();
  SqliteDb& db = impl_->db();
  SqliteTransaction transaction(db);
  require_room(db, jobs.size(), limit);
  std::vector<Job> all;
  for (const Job& job : jobs) {
    all.push_back(fresh_job(job, job.id.empty() ? impl_->new_id() : job.id, unix_time_ms()));
    insert_job(db, all.back());
    insert_event(db, {0, all.back().id, all.back().updated_ms, "submitted", "{}"});
  }
  transaction.commit();
  impl_->notify();
  return all;
}

std::optional<Job> JobStore::claim(int threads, const std::vector<std::string>& except) {
  const std::string passed_over =
      nlohmann::json(except).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  const Impl::Lock lock = impl_->hold();
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
  const Impl::Lock lock = impl_->hold();
  SqliteDb& db = impl_->db();
  SqliteTransaction transaction(db);
  Job before = impl_->require_job(id);
  const Transition transition = require_transition(before, action, token, change);
  if (transition.event.empty()) return before;
  Job after = after_transition(before, transition, change, unix_time_ms());
  if (!update_job(db, before, after)) {
    throw JobStoreError(Fault::conflict, fmt::format("job {} was changed meanwhile", id));
  }
  impl_->commit_with_event(
      transaction, {0, id, after.updated_ms, std::string(transition.event), change.event_detail});
  if (after.state != JobState::running) impl_->progress().forget(id);
  impl_->note_in_folder(before, after);
  return after;
}

void JobStore::record_progress(const std::string& id, const std::string& token,
                               const std::string& progress) {
  const Impl::Lock lock = impl_->hold();
  const Job job = impl_->require_job(id);
  if (job.state != JobState::running || job.token != token) {
    throw JobStoreError(Fault::conflict,
                        fmt::format("job {}: progress of an attempt that is no longer its running "
                                    "one",
                                    id));
  }
  const std::int64_t now = unix_time_ms();
  if (!impl_->progress().note(id, progress, now)) return;
  SqliteTransaction transaction(impl_->db());
  SqliteStatement(impl_->db(), "UPDATE jobs SET progress = ?1, updated_ms = ?2 WHERE id = ?3",
                  progress, now, id)
      .run();
  transaction.commit();
  impl_->progress().note_written(id, now);
}

void JobStore::record_event(const std::string& id, const std::string& name,
                            const std::string& detail) {
  const Impl::Lock lock = impl_->hold();
  SqliteTransaction transaction(impl_->db());
  (void)impl_->require_job(id);
  impl_->commit_with_event(transaction, {0, id, unix_time_ms(), name, detail});
}

Job JobStore::require_ended(const std::string& id) const {
  const Impl::Lock lock = impl_->hold();
  return ended(impl_->require_job(id));
}

void JobStore::remove(const std::string& id) {
  const Impl::Lock lock = impl_->hold();
  SqliteTransaction transaction(impl_->db());
  (void)ended(impl_->require_job(id));
  SqliteStatement(impl_->db(), "DELETE FROM jobs WHERE id = ?1", id).run();
  transaction.commit();
  impl_->notify();
}

std::vector<std::string> JobStore::adopt_all(const std::vector<Adoption>& adoptions) {
  const Impl::Lock lock = impl_->hold();
  SqliteDb& db = impl_->db();
  SqliteTransaction transaction(db);
  std::vector<std::string> refusals;
  for (const auto& [job, key, body_hash] : adoptions) {
    const std::optional<KeyRow> known = key.empty() ? std::nullopt : select_key(db, key);
    if (select_job(db, job.id)) {
      refusals.emplace_back("there is a job of this id");
    } else if (known) {
      refusals.push_back(fmt::format("job {} has the same Idempotency-Key", known->job));
    } else {
      insert_job(db, job);
      if (!key.empty()) insert_key(db, key, {job.id, body_hash});
      insert_event(db, {0, job.id, unix_time_ms(), "adopted", "{}"});
      refusals.emplace_back();
    }
  }
  transaction.commit();
  impl_->notify();
  return refusals;
}

}  // namespace sluice

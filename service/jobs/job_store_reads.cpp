// The members of JobStore that change nothing.

#include "service/jobs/job_store_impl.hpp"

namespace sluice {

std::optional<Job> JobStore::find_by_key(const std::string& key,
                                         const std::string& body_hash) const {
  const Impl::Lock lock = impl_->hold();
  return impl_->job_of_key(key, body_hash);
}

std::optional<Job> JobStore::find(const std::string& id) const {
  const Impl::Lock lock = impl_->hold();
  std::optional<Job> job = select_job(impl_->db(), id);
  if (job) impl_->progress().show_in(*job);
  return job;
}

std::vector<Job> JobStore::list(const JobFilter& filter) const {
  const Impl::Lock lock = impl_->hold();
  std::vector<Job> jobs = select_jobs(impl_->db(), filter);
  for (Job& job : jobs) impl_->progress().show_in(job);
  return jobs;
}

std::vector<std::pair<JobState, std::size_t>> JobStore::count_by_state() const {
  const Impl::Lock lock = impl_->hold();
  std::vector<std::pair<JobState, std::size_t>> counts;
  for (const JobState state : {JobState::queued, JobState::running, JobState::paused,
                               JobState::completed, JobState::failed, JobState::cancelled}) {
    SqliteStatement count(impl_->db(), "SELECT count(*) FROM jobs WHERE state = ?1",
                          to_string(state));
    counts.emplace_back(state, count.step() ? static_cast<std::size_t>(count.integer(0)) : 0);
  }
  return counts;
}

std::vector<std::pair<JobState, std::size_t>> JobStore::count_by_state(
    const std::string& label) const {
  const Impl::Lock lock = impl_->hold();
  std::vector<std::pair<JobState, std::size_t>> counts;
  SqliteStatement rows(impl_->db(),
                       "SELECT state, count(*) FROM jobs WHERE label = ?1 GROUP BY state", label);
  while (rows.step()) {
    if (const auto state = job_state(rows.text(0))) {
      counts.emplace_back(*state, static_cast<std::size_t>(rows.integer(1)));
    }
  }
  return counts;
}

std::vector<JobEvent> JobStore::events(const std::string& id, std::int64_t after,
                                       std::size_t limit) const {
  const Impl::Lock lock = impl_->hold();
  return select_events(impl_->db(), id, after, limit);
}

void JobStore::wait_for_event(const std::string& id, std::int64_t after, double seconds) const {
  impl_->wait_for_event(id, after, seconds);
}

std::int64_t JobStore::last_event() const {
  const Impl::Lock lock = impl_->hold();
  return impl_->db().number("SELECT seq FROM sqlite_sequence WHERE name = 'events'");
}

std::string JobStore::trouble() const { return impl_->trouble(); }

void JobStore::wake() { impl_->wake(); }

}  // namespace sluice

#include "service/retention.hpp"

#include <string_view>
#include <system_error>
#include <vector>

#include "engine/store/job_folder.hpp"
#include "service/job_ids.hpp"
#include "service/study_store.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDeletedPrefix = ".deleted-";
constexpr std::size_t kEndedPage = 500;

/// A study keeps what its run came to.
void keep_for_study(const JobStore& store, const fs::path& data, const std::string& id) {
  const auto job = store.find(id);
  if (!job || !is_ended(job->state) || !is_study_id(job->label)) return;
  const JobPaths paths(data / "jobs" / id);
  std::error_code ignored;
  const bool reported = fs::exists(paths.report(), ignored);
  keep_run(data, job->label, job->name,
           {std::string(to_string(job->state)), job->reason,
            reported ? read_text(paths.report(), JobPaths::kLargestReport) : ""});
}

/// False when the job was deleted or extended by a request at the same time.
bool try_to_delete(JobStore& store, const fs::path& data, const std::string& id) {
  try {
    delete_job(store, data, id);
    return true;
  } catch (const JobStoreError& refusal) {
    const bool raced = refusal.fault() == JobStoreError::Fault::not_found ||
                       refusal.fault() == JobStoreError::Fault::conflict;
    if (!raced) throw;
    return false;
  }
}

std::size_t delete_old_jobs_in(JobStore& store, const fs::path& data, JobState state,
                               std::int64_t limit_ms, std::size_t most) {
  std::size_t deleted = 0;
  JobFilter filter;
  filter.state = state;
  filter.limit = kEndedPage;
  while (deleted < most) {
    const std::vector<Job> page = store.list(filter);
    for (const Job& job : page) {
      const bool old = job.ended_ms > 0 && job.ended_ms < limit_ms;
      if (old && deleted < most && try_to_delete(store, data, job.id)) ++deleted;
    }
    if (page.size() < kEndedPage) break;
    filter.after = page.back().id;
  }
  return deleted;
}

}  // namespace

void delete_job(JobStore& store, const fs::path& data, const std::string& id) {
  keep_for_study(store, data, id);
  const fs::path root = data / "jobs" / id;
  const fs::path hidden = data / "jobs" / (std::string(kDeletedPrefix) + id);
  std::error_code missing;
  fs::rename(root, hidden, missing);
  try {
    store.remove(id);
  } catch (...) {
    if (!missing) fs::rename(hidden, root, missing);
    throw;
  }
  fs::remove_all(hidden, missing);
}

void remove_deleted_folders(const fs::path& data) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator entry(data / "jobs", error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().filename().string().starts_with(kDeletedPrefix)) {
      found.push_back(entry->path());
    }
  }
  for (const fs::path& path : found) fs::remove_all(path, error);
}

std::size_t delete_old_jobs(JobStore& store, const fs::path& data, std::int64_t limit_ms,
                            std::size_t most) {
  std::size_t deleted = 0;
  for (const JobState state : {JobState::completed, JobState::failed, JobState::cancelled}) {
    deleted += delete_old_jobs_in(store, data, state, limit_ms, most - deleted);
  }
  return deleted;
}

}  // namespace sluice

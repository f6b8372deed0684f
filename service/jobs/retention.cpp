#include "service/jobs/retention.hpp"

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <system_error>
#include <vector>

#include "engine/store/disk/errors.hpp"
#include "engine/store/files/job_folder.hpp"
#include "service/jobs/job_ids.hpp"
#include "service/jobs/job_json.hpp"
#include "service/jobs/service_log.hpp"
#include "service/jobs/study_store.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDeletedPrefix = ".deleted-";
constexpr std::size_t kEndedPage = 500;

/// A study keeps what its run came to.
void keep_for_study(const fs::path& data, const Job& job) {
  if (!is_study_id(job.label)) return;
  const JobPaths paths(data / "jobs" / job.id);
  std::string report;
  try {
    report = read_text(paths.report(), JobPaths::kLargestReport, Links::refuse);
  } catch (const StorageError&) {
    // There is none, or none that says anything.
  }
  keep_run(data, job.label, job.name, {std::string(to_string(job.state)), job.reason, report});
}

/// The row with its folder, or neither. Returns where the folder is now.
fs::path take_away(JobStore& store, const fs::path& data, const std::string& id,
                   FileSystem& system) {
  const auto alone = store.alone_with(id);
  // Before anything moves, and for good: only one who is alone with it resumes an ended job. So no
  // job that waits or runs misses its folder, not for a moment.
  keep_for_study(data, store.require_ended(id));
  const fs::path root = data / "jobs" / id;
  const fs::path hidden = deleted_folder(data, id);
  const bool moved = system.rename(root, hidden) == 0;
  if (!moved && errno != ENOENT) throw system_error("cannot remove the folder", root, errno);
  try {
    // Otherwise a power cut could bring it back, and without its row it would be a new job.
    if (moved && system.sync_folder(root.parent_path()) != 0) {
      throw system_error("cannot bring to the disk", root.parent_path(), errno);
    }
    store.remove(id);
  } catch (const JobStoreError& error) {
    const bool undo = moved && error.fault() != JobStoreError::Fault::uncertain;
    if (undo) static_cast<void>(system.rename(hidden, root));
    throw;
  } catch (...) {
    if (moved) static_cast<void>(system.rename(hidden, root));
    throw;
  }
  return hidden;
}

/// False when the job was deleted or extended by a request at the same time, or cannot be deleted
/// now.
bool try_to_delete(JobStore& store, const fs::path& data, const Job& job) {
  try {
    delete_job(store, data, job.id);
    log_line({{"event", "job_deleted"},
              {"job", job.id},
              {"name", job.name},
              {"state", to_string(job.state)},
              {"ended_at", time_json(job.ended_ms)},
              {"message", "it ended longer ago than --retention-days"}});
    return true;
  } catch (const StorageError& error) {
    log_line({{"event", "job_not_deleted"}, {"job", job.id}, {"message", error.what()}});
    return false;
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
      // Ids never go back in time, as a clock may that was wrong when the job ended.
      const std::int64_t ended = std::max(job.ended_ms, time_of_job_id(job.id).value_or(0));
      const bool old = job.ended_ms > 0 && ended < limit_ms;
      if (old && deleted < most && try_to_delete(store, data, job)) ++deleted;
    }
    if (page.size() < kEndedPage) break;
    filter.after = page.back().id;
  }
  return deleted;
}

}  // namespace

void delete_job(JobStore& store, const fs::path& data, const std::string& id, FileSystem& system) {
  std::error_code ignored;
  fs::remove_all(take_away(store, data, id, system), ignored);
}

fs::path deleted_folder(const fs::path& data, const std::string& id) {
  return data / "jobs" / (std::string(kDeletedPrefix) + id);
}

std::vector<std::string> cut_deletions(const fs::path& data) {
  std::vector<std::string> ids;
  std::error_code error;
  for (fs::directory_iterator entry(data / "jobs", error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(kDeletedPrefix)) ids.push_back(name.substr(kDeletedPrefix.size()));
  }
  return ids;
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

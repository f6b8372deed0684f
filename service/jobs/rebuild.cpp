#include "service/jobs/rebuild.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/forecast/estimate.hpp"
#include "engine/scene/format/json_text.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/file_system.hpp"
#include "engine/store/files/job_folder.hpp"
#include "engine/store/files/new_folder.hpp"
#include "service/jobs/admission.hpp"
#include "service/jobs/data_lock.hpp"
#include "service/jobs/job_file.hpp"
#include "service/jobs/job_ids.hpp"
#include "service/jobs/worker_exit.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kAdoptedAtOnce = 500;

/// When a file was last written, Unix time in ms; 0 where there is none.
std::int64_t write_time_ms(const fs::path& path) {
  std::error_code error;
  const fs::file_time_type time = fs::last_write_time(path, error);
  if (error) return 0;
  const auto since = fs::file_time_type::clock::to_sys(time).time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(since).count();
}

/// A link is there too, also one that leads nowhere or to itself.
bool is_there(const fs::path& path) {
  std::error_code error;
  const fs::file_type type = fs::symlink_status(path, error).type();
  return type != fs::file_type::none && type != fs::file_type::not_found;
}

/// What the last attempt that ended left behind.
struct Ending {
  std::string text;
  int exit_code = 0;
  std::string reason;
  double end_time = 0.0;  // model time that it was to reach, s
};

std::optional<Ending> read_ending(const JobPaths& paths, const RebuildReport& report) {
  if (!is_present(paths.outcome())) return std::nullopt;
  try {
    Ending ending;
    const auto object =
        read_stored_json(read_text(paths.outcome(), kMaxStoredBytes, Links::refuse));
    ending.text = object.dump();
    ending.exit_code = object.at("exit_code").get<int>();
    ending.reason = object.at("reason").get<std::string>();
    ending.end_time = object.at("end_time").get<double>();
    return ending;
  } catch (const StorageError& error) {
    if (error.fault() == StorageFault::io) throw;  // it may be whole
    report(paths.root(), fmt::format("outcome.json is none of ours, so the job is taken for one "
                                     "that has not ended: {}",
                                     error.what()));
    return std::nullopt;
  } catch (const std::exception& error) {
    report(paths.root(), fmt::format("outcome.json cannot be read, so the job is taken for one "
                                     "that has not ended: {}",
                                     error.what()));
    return std::nullopt;
  }
}

std::optional<JobFile> read_file(const JobPaths& paths, const RebuildReport& report) {
  try {
    return read_job_file(paths.root());
  } catch (const StorageError& error) {
    // One that cannot be read now may be whole.
    if (error.fault() == StorageFault::io && is_present(job_file_path(paths.root()))) throw;
    report(paths.root(), fmt::format("its label, priority, threads and key are lost, and it is "
                                     "paused: {}",
                                     error.what()));
    return std::nullopt;
  }
}

Scene read_scene(const JobPaths& paths) {
  const ParseResult result =
      parse_job_scene(read_text(paths.scene(), kMaxSceneBytes + 1, Links::refuse),
                      parts_in(paths.root(), Links::refuse));
  if (!result.scene) {
    const Problem& problem = result.problems.front();
    throw std::runtime_error(
        fmt::format("scene.json is no scene: {} {}", problem.pointer, problem.message));
  }
  return *result.scene;
}

void describe_file(Job& job, const JobFile& file) {
  job.label = file.label;
  job.priority = file.priority;
  job.threads = file.threads;
  if (file.created_ms > 0) job.created_ms = file.created_ms;
}

std::string where_it_resumes(const JobPaths& paths) {
  const std::vector<fs::path> checkpoints = paths.checkpoints();
  return checkpoints.empty() ? "from the start"
                             : fmt::format("from {}", checkpoints.front().filename().string());
}

JobState state_after(const Ending& ending, double end_time) {
  const bool reached = ending.end_time >= end_time;
  switch (ending.exit_code) {
    case WorkerExit::checkpointed:
    case WorkerExit::folder_locked:
      return JobState::queued;
    case WorkerExit::storage_failure:
      return JobState::paused;
    case WorkerExit::done:
      return reached ? JobState::completed : JobState::queued;
    default:
      return reached ? JobState::failed : JobState::queued;
  }
}

/// Why an ended job ended, if its outcome is of that end.
std::string reason_of(const Job& job, const std::optional<Ending>& ending) {
  if (ending && state_after(*ending, job.end_time) == job.state) return ending->reason;
  if (job.state != JobState::failed) return "";
  return "it had failed before its row was made anew from its folder; its log tells more";
}

void decide_state(Job& job, const JobPaths& paths, const std::optional<JobFile>& file,
                  const std::optional<Ending>& ending) {
  if (ending) job.state = state_after(*ending, job.end_time);
  if (file && file->held) job.state = *file->held;
  if (!file && job.state == JobState::queued) job.state = JobState::paused;
  if (ending) job.outcome = ending->text;
  if (is_ended(job.state)) {
    const fs::path last = ending ? paths.outcome() : job_file_path(paths.root());
    job.ended_ms = std::max<std::int64_t>(write_time_ms(last), 1);
    job.reason = reason_of(job, ending);
  } else {
    job.reason = fmt::format("its row was made anew from its folder; it resumes {}{}",
                             where_it_resumes(paths),
                             job.state == JobState::paused ? " when it is resumed" : "");
  }
}

/// The folders of jobs. Those that have run come first: of two with one key, the one that never
/// ran is what a broken submission left.
std::vector<fs::path> job_folders(const fs::path& data, const RebuildReport& report) {
  std::vector<fs::path> folders;
  for (const fs::directory_entry& entry : entries_of(data / "jobs")) {
    const fs::path& path = entry.path();
    if (path.filename().string().starts_with('.')) continue;  // being deleted
    if (entry.is_symlink() || !entry.is_directory() || !is_job_id(path.filename().string())) {
      report(path, "no job folder: its name is not one of ours, or it is a link or a file");
      continue;
    }
    folders.push_back(path);
  }
  std::sort(folders.begin(), folders.end());
  std::stable_partition(folders.begin(), folders.end(),
                        [](const fs::path& path) { return is_there(JobPaths(path).log()); });
  return folders;
}

JobStore::Adoption read_folder(const fs::path& folder, const RebuildReport& report) {
  const JobPaths paths(folder);
  Job job;
  job.id = folder.filename().string();
  job.created_ms = time_of_job_id(job.id).value_or(0);
  const Scene scene = read_scene(paths);
  const std::optional<JobFile> file = read_file(paths, report);
  if (file) describe_file(job, *file);
  describe_scene(job, scene, estimate(scene));
  decide_state(job, paths, file, read_ending(paths, report));
  job.updated_ms = std::max(job.created_ms, job.ended_ms);
  return {std::move(job), file ? file->key : "", file ? file->body_hash : ""};
}

/// A passing error of the disk must not leave a job without its row until the next start.
JobStore::Adoption read_surely(const fs::path& folder, const RebuildReport& report) {
  try {
    return read_folder(folder, report);
  } catch (const StorageError&) {
    return read_folder(folder, report);
  }
}

/// Many in one transaction: each alone waits for the disk several times.
std::size_t adopt(JobStore& store, const fs::path& data,
                  const std::vector<JobStore::Adoption>& adoptions, const RebuildReport& report) {
  const std::vector<std::string> refusals = store.adopt_all(adoptions);
  std::size_t taken = 0;
  for (std::size_t k = 0; k < refusals.size(); ++k) {
    if (refusals[k].empty()) {
      ++taken;
    } else {
      report(data / "jobs" / adoptions[k].job.id, fmt::format("not taken: {}", refusals[k]));
    }
  }
  return taken;
}

}  // namespace

std::size_t rebuild_from_folders(JobStore& store, const fs::path& data,
                                 const RebuildReport& report) {
  const RebuildReport tell = report ? report : [](const fs::path&, const std::string&) {};
  remove_unfinished_folders(data / "jobs");
  std::size_t count = 0;
  std::vector<JobStore::Adoption> adoptions;
  for (const fs::path& folder : job_folders(data, tell)) {
    if (store.find(folder.filename().string())) continue;
    try {
      adoptions.push_back(read_surely(folder, tell));
    } catch (const std::exception& error) {
      tell(folder, fmt::format("not taken: {}", error.what()));
    }
    if (adoptions.size() < kAdoptedAtOnce) continue;
    count += adopt(store, data, adoptions, tell);
    adoptions.clear();
  }
  return adoptions.empty() ? count : count + adopt(store, data, adoptions, tell);
}

std::optional<fs::path> set_aside_database(const fs::path& data) {
  const DataLock lock(data);
  const fs::path file = data / "jobs.sqlite";
  if (!is_there(file)) return std::nullopt;
  const fs::path aside = fmt::format("{}.bad-{}", file.string(), unix_time_ms());
  try {
    const fs::path journal = file.string() + "-journal";
    if (is_there(journal)) fs::rename(journal, aside.string() + "-journal");
    fs::rename(file, aside);
  } catch (const fs::filesystem_error& error) {
    throw JobStoreError(JobStoreError::Fault::io, error.what());
  }
  return aside;
}

}  // namespace sluice

#include "engine/store/files/job_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <system_error>

#include "engine/store/disk/apart.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/publish.hpp"
#include "engine/store/files/snapshot_io.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHere = ".";
/// Far above any scene that the parser takes.
constexpr std::uint64_t kLargestScene = std::uint64_t{1} << 24;

std::uint64_t step_of(const fs::path& path) {
  return step_of_checkpoint_name(path.filename().string()).value_or(0);
}

fs::path absolute_or_same(const fs::path& path) {
  std::error_code error;
  fs::path absolute = fs::absolute(path, error);
  return error ? path : absolute;
}

void require_writable(const fs::path& folder) {
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw system_error("cannot write in this folder", folder, errno);
  }
}

/// Of a folder without a scene.
std::string what_it_lacks(const JobPaths& paths) {
  const auto checkpoints = paths.checkpoints();
  if (checkpoints.empty()) {
    return "this is no job folder: there is no scene.json in it; make one by running a scene file";
  }
  return fmt::format(
      "scene.json is missing, while {} is there: put the scene of this run back as "
      "scene.json, and it resumes",
      checkpoints.front().filename().string());
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (std::error_code ignored; error && !fs::is_directory(folder, ignored)) {
    throw system_error("cannot make the folder", folder, error.value());
  }
}

/// An empty folder, or one in which the making of a job was cut short: with its lock, and parts of
/// its scene.
void require_free_folder(const fs::path& folder, const std::vector<NamedPart>& begun) {
  if (JobFolder::holds_job(folder)) {
    throw StorageError(StorageFault::already_exists,
                       fmt::format("{}: holds a job already; resume it by its folder, or choose "
                                   "another one",
                                   folder.string()));
  }
  const std::vector<fs::path> others = sorted_paths(folder, [&](std::string_view name) {
    return name != "lock" && std::ranges::find(begun, name, &NamedPart::name) == begun.end();
  });
  if (!others.empty()) {
    throw StorageError(
        StorageFault::not_ours,
        fmt::format("{}: not empty (it holds '{}') and no job; choose another folder",
                    folder.string(), others.front().filename().string()));
  }
}

/// Which older checkpoint stays besides the two newest: the oldest from half of the newest's steps
/// on, so that it lies well back and yet moves on; else the youngest there is. `older` is sorted
/// newest first.
const fs::path& older_to_keep(const std::vector<fs::path>& older, std::uint64_t newest_step) {
  const auto too_old = std::find_if(older.begin(), older.end(), [&](const fs::path& path) {
    return step_of(path) < newest_step - newest_step / 2;
  });
  return too_old == older.begin() ? older.front() : *std::prev(too_old);
}

}  // namespace

JobFolder::JobFolder(JobPaths paths, FileSystem& system)
    : name_(paths.root()),
      absolute_(absolute_or_same(name_)),
      paths_(std::move(paths)),
      lock_(paths_.lock()),
      system_(&system) {
  remove_leftovers();
}

void JobFolder::remove_leftovers() const {
  sluice::remove_leftovers(paths_.root());
  sluice::remove_leftovers(paths_.frames());
}

JobFolder JobFolder::create(const fs::path& folder, std::string_view scene_text,
                            const std::vector<NamedPart>& parts, FileSystem& system) {
  make_folder(folder);
  require_writable(folder);
  // Before the lock, so that no lock file is left in a folder of someone else.
  std::error_code ignored;
  if (!fs::is_regular_file(fs::symlink_status(JobPaths(folder).lock(), ignored))) {
    require_free_folder(folder, {});
  }
  JobFolder job(JobPaths(folder), system);
  require_free_folder(folder, parts);
  // The scene last: it makes the folder a job's.
  for (const NamedPart& part : parts) job.publish_text(job.paths_.part(part.name), part.bytes);
  job.publish_text(job.paths_.scene(), scene_text);
  storing([&] { fs::create_directory(job.paths_.frames()); });
  return job;
}

JobFolder JobFolder::open(const fs::path& folder, FileSystem& system) {
  if (!holds_job(folder)) {
    throw StorageError(StorageFault::not_ours,
                       fmt::format("{}: {}", folder.string(), what_it_lacks(JobPaths(folder))));
  }
  require_writable(folder);
  return {JobPaths(folder), system};
}

bool JobFolder::holds_job(const fs::path& folder) {
  return file_type_at(JobPaths(folder).scene()) == fs::file_type::regular;
}

fs::path JobFolder::name() const {
  std::error_code error;
  if (fs::equivalent(absolute_, paths_.root(), error)) return name_;
  const fs::path now = fs::canonical(paths_.root(), error);
  return error ? name_ : now;
}

void JobFolder::enter() {
  if (paths_.root() == kHere) return;
  if (::chdir(paths_.root().c_str()) != 0) {
    throw system_error("cannot enter the folder", paths_.root(), errno);
  }
  paths_ = JobPaths(kHere);
  require_held();
}

bool JobFolder::is_held() const {
  try {
    return lock_.is_at(paths_.lock());
  } catch (const StorageError&) {
    return true;
  }
}

void JobFolder::require_held() const {
  if (lock_.is_at(paths_.lock())) return;
  throw StorageError(
      StorageFault::lost,
      fmt::format("{}: this folder or the lock file in it was removed or replaced while the job "
                  "ran; nothing more is written there. A copy of the folder resumes from its "
                  "newest checkpoint",
                  name_.string()));
}

std::string JobFolder::scene_text() const { return read_text(paths_.scene(), kLargestScene); }

std::optional<Restored> JobFolder::newest_checkpoint(const CheckpointIdentity& identity) {
  std::vector<std::string> rejected;
  for (const fs::path& path : paths_.checkpoints()) {
    try {
      Checkpoint checkpoint = read_harmless(path, [&] { return read_checkpoint(path, identity); });
      if (checkpoint.solver.step != step_of(path)) {
        throw StorageError(StorageFault::corrupt,
                           fmt::format("{}: holds step {}", path.string(), checkpoint.solver.step));
      }
      verified_.insert(path);
      return Restored{std::move(checkpoint), path, std::move(rejected)};
    } catch (const StorageError& error) {
      if (error.fault() != StorageFault::corrupt && error.fault() != StorageFault::not_ours) {
        throw;
      }
      rejected.push_back(put_aside(path, error));
    }
  }
  const std::vector<fs::path> bad = paths_.bad_checkpoints();
  if (bad.empty()) {
    return std::nullopt;
  }
  throw StorageError(
      StorageFault::no_usable_checkpoint,
      fmt::format("{}: none of its {} checkpoints can be used{}{}; they are kept with the ending "
                  "'{}'. To begin again from the scene, remove them",
                  name().string(), bad.size(), rejected.empty() ? "" : ": ",
                  fmt::join(rejected, "; "), kBadSuffix));
}

fs::path JobFolder::write_checkpoint(const Checkpoint& checkpoint) {
  require_held();
  fs::path path = sluice::write_checkpoint(paths_.root(), checkpoint, *system_);
  verified_.insert(path);
  return path;
}

std::vector<std::string> JobFolder::prune() {
  std::vector<std::string> rejected;
  std::vector<fs::path> good = paths_.checkpoints();
  std::erase_if(good, [&](const fs::path& path) { return !is_verified(path, rejected); });
  if (good.size() <= 3) return rejected;
  const std::vector<fs::path> older(good.begin() + 2, good.end());
  const fs::path& kept = older_to_keep(older, step_of(good.front()));
  for (const fs::path& path : older) {
    std::error_code ignored;  // One that cannot be removed is only tried again next time
    if (path != kept && fs::remove(path, ignored)) verified_.erase(path);
  }
  return rejected;
}

void JobFolder::publish_text(const fs::path& path, std::string_view text) {
  require_held();
  sluice::publish_text(path, text, *system_);
}

std::string JobFolder::put_aside(const fs::path& path, const StorageError& error) {
  const fs::path aside = path.string() + std::string(kBadSuffix);
  verified_.erase(path);
  if (system_->rename(path, aside) != 0) {
    throw system_error("cannot rename this damaged checkpoint", path, errno);
  }
  return fmt::format("{}; it is kept as {}", told_outside(name(), std::string(error.what())),
                     aside.filename().string());
}

bool JobFolder::is_verified(const fs::path& path, std::vector<std::string>& rejected) {
  if (verified_.contains(path)) {
    return true;
  }
  try {
    verify(path);
  } catch (const StorageError& error) {
    if (error.fault() == StorageFault::corrupt) rejected.push_back(put_aside(path, error));
    return false;
  }
  verified_.insert(path);
  return true;
}

}  // namespace sluice

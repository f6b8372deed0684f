#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/store/disk/file_system.hpp"
#include "engine/store/files/checkpoint.hpp"
#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/folder_lock.hpp"
#include "engine/store/files/job_paths.hpp"
#include "engine/store/files/scene_parts.hpp"

namespace sluice {

/// A checkpoint to go on from and what was put aside on the way to it.
struct Restored {
  Checkpoint checkpoint;
  std::filesystem::path path;
  std::vector<std::string> rejected;  ///< one reason per newer checkpoint renamed to `.bad`
};

/// A job folder held under its lock. All physics of the job is in it; see schemas/checkpoint.md.
class JobFolder {
 public:
  /// Makes the folder (its parents too) with the scene's text and parts in it, and locks it. Throws
  /// StorageError: already_exists when it holds a job; not_ours when it holds anything else;
  /// unwritable, locked, disk_full, io.
  [[nodiscard]] static JobFolder create(const std::filesystem::path& folder,
                                        std::string_view scene_text,
                                        const std::vector<NamedPart>& parts = {},
                                        FileSystem& system = FileSystem::real());
  /// Locks an existing one and removes what killed processes left. Throws StorageError: not_ours
  /// when there is no scene in it; unwritable, locked, io.
  [[nodiscard]] static JobFolder open(const std::filesystem::path& folder,
                                      FileSystem& system = FileSystem::real());
  /// Whether `open` would find a job there. Throws StorageError when the system cannot tell.
  [[nodiscard]] static bool holds_job(const std::filesystem::path& folder);

  [[nodiscard]] const JobPaths& paths() const { return paths_; }
  /// The path of the folder for people: the one that it was opened by, or where it is since.
  [[nodiscard]] std::filesystem::path name() const;
  /// The open lock file.
  [[nodiscard]] int lock() const { return lock_.descriptor(); }

  /// Makes the folder this process's working directory and its paths relative to it: what is
  /// written goes into this very folder, whatever it is called later. Before checkpoints are read
  /// or written. Throws StorageError: lost, unwritable, io.
  void enter();
  /// Throws StorageError(lost) unless this very folder is at its paths, with the lock that is held
  /// in it, or io where the system cannot tell. To be asked before anything is written.
  void require_held() const;
  /// The same as an answer: true also where the system cannot tell.
  [[nodiscard]] bool is_held() const;

  [[nodiscard]] std::string scene_text() const;

  /// The newest checkpoint that can be used; empty when the job never had one. A damaged one is
  /// renamed to `.bad` and the one before it taken. Throws StorageError: no_usable_checkpoint when
  /// there are or were checkpoints and none can be used; wrong_scene, unsupported_version and io
  /// leave every file as it is, because the checkpoint may be whole.
  [[nodiscard]] std::optional<Restored> newest_checkpoint(const CheckpointIdentity& identity);

  /// Publishes a checkpoint; it survives a power cut. Older ones stay until `prune`.
  std::filesystem::path write_checkpoint(const Checkpoint& checkpoint);

  /// Removes checkpoints but for the two newest verified ones and an older one, which lies at half
  /// of the newest's steps or later where such a one is left. One found damaged is renamed to
  /// `.bad` and does not count; returns a reason for each.
  [[nodiscard]] std::vector<std::string> prune();

  /// Removes what killed processes left, and what failed writes of this one could not remove.
  void remove_leftovers() const;

  /// Publishes a text in this folder, such as outcome.json.
  void publish_text(const std::filesystem::path& path, std::string_view text);

 private:
  JobFolder(JobPaths paths, FileSystem& system);
  /// Renames a damaged checkpoint to `.bad`; returns the reason with its new name.
  [[nodiscard]] std::string put_aside(const std::filesystem::path& path, const StorageError& error);
  [[nodiscard]] bool is_verified(const std::filesystem::path& path,
                                 std::vector<std::string>& rejected);

  std::filesystem::path name_;
  std::filesystem::path absolute_;  ///< of name_
  JobPaths paths_;
  FolderLock lock_;
  FileSystem* system_;
  std::set<std::filesystem::path> verified_;
};

}  // namespace sluice

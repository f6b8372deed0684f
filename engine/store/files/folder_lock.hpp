#pragma once

#include <filesystem>

#include "engine/store/disk/file_system.hpp"

namespace sluice {

/// Sole use of a job folder: an flock on its lock file for the life of the holder. The system frees
/// it when the process ends, however it ends. The file holds the holder's process number, for
/// people; it is empty again at the end of the holder's life, but not after a kill.
class FolderLock {
 public:
  /// Throws StorageError: locked, naming the holder's process; unwritable; not_ours when the lock
  /// file is a symbolic link or no regular file.
  explicit FolderLock(const std::filesystem::path& path);
  FolderLock(FolderLock&&) noexcept = default;
  FolderLock& operator=(FolderLock&&) noexcept = default;
  ~FolderLock();

  [[nodiscard]] int descriptor() const { return descriptor_.get(); }
  /// Whether the file at `path` is the one that is locked. Throws StorageError when the system
  /// cannot tell.
  [[nodiscard]] bool is_at(const std::filesystem::path& path) const;

 private:
  FileDescriptor descriptor_;
};

}  // namespace sluice

#pragma once

#include <filesystem>
#include <string>

#include "engine/store/disk/file_system.hpp"

namespace sluice {

enum class LastStop { clean, unclean };

/// Sole use of a data folder: an flock on DATA/lock, which the system frees however the holder
/// ends. The file holds the holder's process number, and the word "stopped" after a clean stop.
/// Its length stays the same, so that a service starts on a full disk, too.
class DataLock {
 public:
  /// Makes the folder when it is missing. Throws JobStoreError: in_use, naming the holder;
  /// disk_full, io.
  explicit DataLock(const std::filesystem::path& data);
  /// Frees the folder but does not call the stop a clean one.
  ~DataLock() = default;
  DataLock(const DataLock&) = delete;
  DataLock& operator=(const DataLock&) = delete;

  /// Unclean, too, when nothing tells of the last stop.
  [[nodiscard]] LastStop last_stop() const { return last_stop_; }
  /// Why the folder is not the one that was locked any more, or cannot be written in; empty when
  /// all is well.
  [[nodiscard]] std::string trouble() const;
  /// The last act of a clean stop. Says nothing when it fails: the next start checks the more.
  void note_clean_stop();

 private:
  std::filesystem::path path_;
  FileDescriptor descriptor_;
  LastStop last_stop_ = LastStop::unclean;
};

}  // namespace sluice

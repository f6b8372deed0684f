#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <vector>

#include "engine/store/series.hpp"

namespace sluice {

/// Keeps the last few series files that were read, so that several questions about one job read its
/// file once. A file is known by its inode, size and time of change. Thread-safe.
class SeriesCache {
 public:
  using Content = std::shared_ptr<const std::vector<Series>>;

  /// Null when there is no such file. Throws what read_series throws.
  [[nodiscard]] Content read(const std::filesystem::path& path);

 private:
  struct Stamp {
    unsigned long device = 0;
    unsigned long inode = 0;
    long size = 0;
    long changed_seconds = 0;
    long changed_nanoseconds = 0;
    friend bool operator==(const Stamp&, const Stamp&) = default;
  };
  struct Entry {
    std::filesystem::path path;
    Stamp stamp;
    Content content;
  };

  std::mutex mutex_;
  std::vector<Entry> entries_;  ///< oldest first
};

}  // namespace sluice

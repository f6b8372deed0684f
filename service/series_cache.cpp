#include "service/series_cache.hpp"

#include <sys/stat.h>

#include <algorithm>

#include "engine/store/series_file.hpp"

namespace sluice {
namespace {

constexpr std::size_t kEntries = 4;
/// Larger files are read each time rather than kept, bytes.
constexpr long kLargest = 4L << 20;

}  // namespace

SeriesCache::Content SeriesCache::read(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return nullptr;
  const Stamp stamp{status.st_dev, status.st_ino, status.st_size, status.st_mtim.tv_sec,
                    status.st_mtim.tv_nsec};
  {
    const std::scoped_lock lock(mutex_);
    for (const Entry& entry : entries_) {
      if (entry.path == path && entry.stamp == stamp) return entry.content;
    }
  }
  auto content = std::make_shared<const std::vector<Series>>(read_series(path));
  if (status.st_size > kLargest) return content;
  const std::scoped_lock lock(mutex_);
  std::erase_if(entries_, [&](const Entry& entry) { return entry.path == path; });
  if (entries_.size() == kEntries) entries_.erase(entries_.begin());
  entries_.push_back({path, stamp, content});
  return content;
}

}  // namespace sluice

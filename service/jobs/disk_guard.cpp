#include "service/jobs/disk_guard.hpp"

#include <sys/stat.h>

#include <system_error>

#include "engine/store/disk/file_system.hpp"

namespace sluice {

namespace fs = std::filesystem;

std::uint64_t free_disk(const fs::path& folder) { return FileSystem::real().free_bytes(folder); }

std::uint64_t used_disk(const fs::path& folder) {
  constexpr std::uint64_t kBlock = 512;  // the unit of st_blocks, whatever the file system's is
  std::uint64_t total = 0;
  std::error_code error;
  const auto options = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator entry(folder, options, error), end; !error && entry != end;
       entry.increment(error)) {
    struct stat status {};
    if (::lstat(entry->path().c_str(), &status) != 0) continue;
    total += static_cast<std::uint64_t>(status.st_blocks) * kBlock;
  }
  return total;
}

}  // namespace sluice

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/store/disk/file_system.hpp"
#include "service/jobs/job_store.hpp"

namespace sluice {

/// Deletes an ended job, row and folder, or does nothing and throws. The folder goes out of sight
/// first and comes back unless the row could be removed; what is left when this is cut short,
/// repair_folders() brings to its end. Of several callers for one job only one deletes it. Throws
/// JobStoreError as JobStore::remove does; StorageError when the folder cannot be moved.
void delete_job(JobStore& store, const std::filesystem::path& data, const std::string& id,
                FileSystem& system = FileSystem::real());

/// Where the folder of a job stands while it is deleted.
[[nodiscard]] std::filesystem::path deleted_folder(const std::filesystem::path& data,
                                                   const std::string& id);
/// The ids of jobs whose deletion was cut short.
[[nodiscard]] std::vector<std::string> cut_deletions(const std::filesystem::path& data);

/// Deletes jobs that ended before `limit_ms` (Unix time, ms), at most `most` of them, so that
/// nobody waits long, and logs each. Returns how many.
std::size_t delete_old_jobs(JobStore& store, const std::filesystem::path& data,
                            std::int64_t limit_ms, std::size_t most);

}  // namespace sluice

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "service/job_store.hpp"

namespace sluice {

/// Deletes an ended job, row and folder. The folder goes out of sight first and comes back unless
/// the row could be removed; what is left when this is cut short, remove_deleted_folders() removes.
/// Throws JobStoreError as JobStore::remove does.
void delete_job(JobStore& store, const std::filesystem::path& data, const std::string& id);

/// Removes the folders of jobs whose deletion was cut short.
void remove_deleted_folders(const std::filesystem::path& data);

/// Deletes jobs that ended before `limit_ms` (Unix time, ms), at most `most` of them, so that
/// nobody waits long. Returns how many.
std::size_t delete_old_jobs(JobStore& store, const std::filesystem::path& data,
                            std::int64_t limit_ms, std::size_t most);

}  // namespace sluice

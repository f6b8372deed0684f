#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "service/jobs/job_store.hpp"

namespace sluice {

/// Told of each folder that was not taken as it is: which, and why.
using RebuildReport = std::function<void(const std::filesystem::path& folder, const std::string&)>;

/// Inserts a row for each job folder in DATA/jobs that has none, made from its scene.json,
/// outcome.json and job.json (job_file.hpp); returns how many. Rows that are there are left alone.
///
/// A job becomes completed or failed as its outcome says, unless its scene now ends later; paused
/// or cancelled as its job.json says; else queued, to go on from its newest checkpoint. Without a
/// readable job.json it becomes paused, so that nothing runs that nobody asked for. What only rows
/// know is lost: history, attempts, the last progress.
///
/// Folders that a submission had not finished (new_folder.hpp) are removed: nobody was told of
/// those jobs. For use before the service takes requests.
///
/// Damaged folders, those of other names and a second one with the same Idempotency-Key are
/// reported and passed over. Throws JobStoreError as the store does, StorageError where the folder
/// itself cannot be listed.
std::size_t rebuild_from_folders(JobStore& store, const std::filesystem::path& data,
                                 const RebuildReport& report = {});

/// Renames DATA/jobs.sqlite to jobs.sqlite.bad-TIME, with its journal, so that the next JobStore
/// begins with an empty one; returns the new name, or nothing where there was no file. Throws
/// JobStoreError: in_use, io.
std::optional<std::filesystem::path> set_aside_database(const std::filesystem::path& data);

}  // namespace sluice

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "service/jobs/job.hpp"

namespace sluice {

/// What a job's folder keeps of its row, in job.json: all that the scene and the outcome do not
/// tell. Rows are made anew from it (rebuild.hpp).
struct JobFile {
  std::string label;
  int priority = 0;
  int threads = 1;
  std::int64_t created_ms = 0;  ///< Unix time, ms
  std::string key;              ///< Idempotency-Key, may be empty
  std::string body_hash;        ///< of the body that came with the key
  /// paused, cancelled or failed while the job is held; otherwise the outcome tells.
  std::optional<JobState> held;
  friend bool operator==(const JobFile&, const JobFile&) = default;
};

/// What `held` says of a job in this state. A rebuild could not tell it from the outcome: a job
/// that failed may have left none.
[[nodiscard]] std::optional<JobState> held_in(JobState state);

/// `job.json` in a job's folder.
[[nodiscard]] std::filesystem::path job_file_path(const std::filesystem::path& folder);
/// What stands in it.
[[nodiscard]] std::string job_file_text(const JobFile& file);
/// Whole or not at all, and it survives a power cut. Throws StorageError: disk_full, unwritable,
/// io.
void write_job_file(const std::filesystem::path& folder, const JobFile& file);
/// Throws StorageError: corrupt when it is not as written, io when it cannot be read.
[[nodiscard]] JobFile read_job_file(const std::filesystem::path& folder);

/// Notes in the folder that the job is held, or no longer. Does nothing in a folder without a file.
/// Throws as the two above.
void note_held(const std::filesystem::path& folder, std::optional<JobState> held);

}  // namespace sluice

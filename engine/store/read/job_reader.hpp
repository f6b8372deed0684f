#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/scene/model/scene.hpp"
#include "engine/store/files/job_paths.hpp"
#include "engine/store/files/series.hpp"

namespace sluice {

/// outcome.json; null where there is none, or none that reads as JSON. No link is followed.
[[nodiscard]] nlohmann::ordered_json read_outcome(const std::filesystem::path& folder);

/// What there is of a job: the run may be going on, or have ended before its first sample.
struct JobRecord {
  Scene scene;
  std::vector<Series> series;
  nlohmann::ordered_json outcome;
};

/// A job's folder as a reader sees it, running or not: no lock is taken, nothing is changed and no
/// link is followed. HDF5 files are read in a child process first, so that none hurts this one.
class JobReader {
 public:
  /// Throws StorageError(not_ours) when the folder holds no job.
  explicit JobReader(const std::filesystem::path& folder);

  [[nodiscard]] const JobPaths& paths() const { return paths_; }
  [[nodiscard]] std::string scene_text() const;
  /// Throws SceneError, with the first problem, for a scene that cannot be read.
  [[nodiscard]] Scene scene() const;
  /// From series.h5, else from the newest readable checkpoint; none before there is either. Throws
  /// StorageError for a damaged series.h5.
  [[nodiscard]] std::vector<Series> series() const;
  [[nodiscard]] nlohmann::ordered_json outcome() const { return read_outcome(paths_.root()); }
  /// Whether the last attempt reached the end time: filtered values are then final.
  [[nodiscard]] bool completed() const;
  /// Without a look at files of samples where the scene has no sensors.
  [[nodiscard]] JobRecord record() const;

 private:
  JobPaths paths_;
};

}  // namespace sluice

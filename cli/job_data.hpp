#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/scene/model/scene.hpp"
#include "engine/store/files/job_folder.hpp"
#include "engine/store/files/series.hpp"

namespace sluice {

/// A job as a reader sees it, running or not: no lock is taken and nothing is changed.
class JobData {
 public:
  /// Throws CommandEnd(usage) when the folder holds no job.
  explicit JobData(const std::filesystem::path& folder);

  [[nodiscard]] const JobPaths& paths() const { return paths_; }
  [[nodiscard]] Scene scene() const;
  /// From series.h5, else from the newest readable checkpoint. Throws CommandEnd when there are
  /// none yet.
  [[nodiscard]] std::vector<Series> series() const;
  /// Whether the last attempt reached the end time: filtered values are then final.
  [[nodiscard]] bool completed() const;

 private:
  JobPaths paths_;
};

/// Throws CommandEnd(usage) for a word of a verb that also takes ids when it is no folder that can
/// be read.
void require_folder(const std::string& word);

/// The series of this name; throws CommandEnd(not_found) with the nearest names.
[[nodiscard]] const Series& find_series(const std::vector<Series>& all, const std::string& name);

}  // namespace sluice

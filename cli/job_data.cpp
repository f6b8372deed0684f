#include "cli/job_data.hpp"

#include <fmt/format.h>

#include <string_view>

#include "cli/checks.hpp"
#include "cli/scene_file.hpp"
#include "cli/verbs.hpp"
#include "engine/report/report.hpp"
#include "engine/scene/checks/parse.hpp"
#include "engine/scene/model/problems.hpp"
#include "engine/store/disk/apart.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/series_file.hpp"

namespace sluice {

void require_folder(const std::string& word) {
  std::string path = word;
  const std::string wrong = existing_folder()(path);
  if (wrong.empty()) return;
  throw CommandEnd(ExitCode::usage,
                   fmt::format("{}; for a job of a service, add --server URL", wrong));
}

JobData::JobData(const std::filesystem::path& folder) : paths_(folder) {
  if (JobFolder::holds_job(folder)) return;
  throw CommandEnd(
      ExitCode::usage,
      fmt::format("{} holds no job: give the folder that sluice run made", folder.string()));
}

Scene JobData::scene() const {
  return job_scene_or_end(read_text(paths_.scene(), kMaxSceneBytes + 1), paths_.scene());
}

std::vector<Series> JobData::series() const {
  if (std::filesystem::exists(paths_.series())) {
    return read_harmless(paths_.series(), [&] { return read_series(paths_.series()); });
  }
  for (const std::filesystem::path& path : paths_.checkpoints()) {
    try {
      return split(read_harmless(path, [&] { return read_checkpoint(path); }).samples);
    } catch (const StorageError&) {
      continue;  // Putting it aside is for the run, which holds the lock.
    }
  }
  throw CommandEnd(ExitCode::usage,
                   fmt::format("{} has no samples yet: its scene has no sensors, or it did not run",
                               paths_.root().string()));
}

bool JobData::completed() const {
  if (!std::filesystem::exists(paths_.outcome())) return false;
  const auto outcome = read_outcome(paths_.root());
  return outcome.is_object() && outcome.contains("state") && outcome["state"] == "completed";
}

const Series& find_series(const std::vector<Series>& all, const std::string& name) {
  std::vector<std::string_view> names;
  for (const Series& series : all) {
    if (series.name == name) return series;
    names.push_back(series.name);
  }
  throw CommandEnd(ClientExit::not_found,
                   fmt::format("there is no sensor {}: {}", name, hint(name, names)));
}

}  // namespace sluice

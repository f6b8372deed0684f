#include "engine/store/read/job_reader.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/format/json_text.hpp"
#include "engine/scene/model/problems.hpp"
#include "engine/store/disk/apart.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/file_system.hpp"
#include "engine/store/disk/publish.hpp"
#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/job_folder.hpp"
#include "engine/store/files/scene_parts.hpp"
#include "engine/store/files/series_file.hpp"

namespace sluice {
namespace {

/// Far more than any text of a job needs.
constexpr std::size_t kMaxTextBytes = 1024 * 1024;

}  // namespace

nlohmann::ordered_json read_outcome(const std::filesystem::path& folder) {
  const JobPaths paths(folder);
  if (!is_present(paths.outcome())) return nullptr;
  const std::string text = read_text(paths.outcome(), kMaxTextBytes, Links::refuse);
  try {
    return read_stored_json(text);
  } catch (const std::runtime_error&) {
    return nullptr;
  }
}

JobReader::JobReader(const std::filesystem::path& folder) : paths_(folder) {
  if (JobFolder::holds_job(folder)) return;
  throw StorageError(
      StorageFault::not_ours,
      fmt::format("{}: holds no job; name a folder that `sluice run` made", folder.string()));
}

std::string JobReader::scene_text() const {
  return read_text(paths_.scene(), kMaxTextBytes, Links::refuse);
}

Scene JobReader::scene() const {
  ParseResult parsed = parse_job_scene(scene_text(), parts_in(paths_.root(), Links::refuse));
  if (!parsed.scene) throw SceneError(parsed.problems.front());
  return *std::move(parsed.scene);
}

std::vector<Series> JobReader::series() const {
  if (is_present(paths_.series())) {
    return read_harmless(paths_.series(), [&] { return read_series(paths_.series()); });
  }
  for (const std::filesystem::path& path : paths_.checkpoints()) {
    try {
      return split(read_harmless(path, [&] { return read_checkpoint(path); }).samples);
    } catch (const StorageError&) {
      continue;  // Putting it aside is for the run, which holds the lock.
    }
  }
  return {};
}

JobRecord JobReader::record() const {
  Scene of_job = scene();
  std::vector<Series> samples;
  if (!of_job.sensors.empty()) samples = series();
  return {std::move(of_job), std::move(samples), outcome()};
}

bool JobReader::completed() const {
  const auto last = outcome();
  return last.is_object() && last.contains("state") && last["state"] == "completed";
}

}  // namespace sluice

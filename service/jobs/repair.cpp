#include "service/jobs/repair.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/format/json_text.hpp"
#include "engine/store/disk/publish.hpp"
#include "engine/store/files/job_folder.hpp"
#include "service/jobs/job_file.hpp"
#include "service/jobs/retention.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

void settle_deletion(const JobStore& store, const fs::path& data, const std::string& id) {
  const fs::path hidden = deleted_folder(data, id);
  const fs::path root = data / "jobs" / id;
  if (store.find(id) && !fs::exists(root)) {
    fs::rename(hidden, root);
  } else {
    fs::remove_all(hidden);
  }
}

/// Whether the scene ends at another time than the row says.
bool ends_elsewhere(const JobPaths& paths, const Job& job) {
  const auto scene = read_stored_json(read_text(paths.scene(), kMaxSceneBytes + 1, Links::refuse));
  const auto end_time = scene.find("end_time");
  return end_time != scene.end() && end_time->is_number() &&
         end_time->get<double>() != job.end_time;
}

void mend_folder(const JobPaths& paths, const Job& job) {
  note_held(paths.root(), held_in(job.state));
  const bool elsewhere = ends_elsewhere(paths, job);
  if (!elsewhere && !has_leftovers(paths.root())) return;
  JobFolder folder = JobFolder::open(paths.root());  // which removes the leftovers
  if (elsewhere) {
    folder.publish_text(paths.scene(), with_end_time(folder.scene_text(), job.end_time));
  }
}

template <class Action>
void or_report(const fs::path& folder, const RebuildReport& report, const Action& action) {
  try {
    action();
  } catch (const JobStoreError&) {
    throw;
  } catch (const std::exception& error) {
    if (report) report(folder, error.what());
  }
}

}  // namespace

void repair_folders(JobStore& store, const fs::path& data, const RebuildReport& report) {
  for (const std::string& id : cut_deletions(data)) {
    or_report(deleted_folder(data, id), report, [&] { settle_deletion(store, data, id); });
  }
  JobFilter filter;
  filter.limit = 500;
  for (;;) {
    const std::vector<Job> page = store.list(filter);
    for (const Job& job : page) {
      const JobPaths paths(data / "jobs" / job.id);
      std::error_code ignored;
      if (!fs::exists(paths.scene(), ignored)) continue;
      or_report(paths.root(), report, [&] { mend_folder(paths, job); });
    }
    if (page.size() < filter.limit) return;
    filter.after = page.back().id;
  }
}

std::string with_end_time(const std::string& scene, double end_time) {
  auto object = read_stored_json(scene);
  if (!object.is_object()) throw std::runtime_error("the scene is no object");
  object["end_time"] = end_time;
  std::string readable = object.dump(2) + "\n";
  return readable.size() > kMaxSceneBytes ? object.dump() : readable;
}

}  // namespace sluice

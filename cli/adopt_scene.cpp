#include "cli/adopt_scene.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "cli/scene_file.hpp"
#include "cli/verbs.hpp"
#include "engine/scene/canonical.hpp"
#include "engine/scene/parse.hpp"

namespace sluice {
namespace {

constexpr std::size_t kShown = 3;

std::string value_at(const nlohmann::json& flat, const std::string& pointer) {
  const auto found = flat.find(pointer);
  return found == flat.end() ? "left out" : found->dump();
}

/// Where two scenes differ: "/resolution/spacing is 0.02 there and 0.03 here", the first few.
std::string differences(const Scene& there, const Scene& here) {
  const nlohmann::json old_values = nlohmann::json::parse(identity_text(there)).flatten();
  const nlohmann::json new_values = nlohmann::json::parse(identity_text(here)).flatten();
  std::set<std::string> pointers;
  for (const auto* values : {&old_values, &new_values}) {
    for (const auto& [pointer, value] : values->items()) {
      if (value_at(old_values, pointer) != value_at(new_values, pointer)) pointers.insert(pointer);
    }
  }
  std::vector<std::string> shown;
  for (const std::string& pointer : pointers) {
    if (shown.size() == kShown) break;
    shown.push_back(fmt::format("{} is {} there and {} here", pointer,
                                value_at(old_values, pointer), value_at(new_values, pointer)));
  }
  const std::size_t more = pointers.size() - shown.size();
  return fmt::format("{}{}", fmt::join(shown, ", "),
                     more == 0 ? "" : fmt::format(", and {} more", more));
}

}  // namespace

void adopt_scene(JobFolder& folder, const std::string& text, const Scene& scene) {
  const std::filesystem::path path = folder.paths().scene();
  const Scene present = job_scene_or_end(folder.scene_text(), path);
  if (identity_text(present) != identity_text(scene)) {
    throw CommandEnd(ExitCode::invalid_scene,
                     fmt::format("{} holds a run of another scene: {}; choose another folder with "
                                 "--folder, or remove that one",
                                 folder.name().string(), differences(present, scene)));
  }
  if (canonical_text(present) != canonical_text(scene)) folder.publish_text(path, text);
}

void prepare_folder(const std::filesystem::path& root, const std::string& text,
                    const Scene& scene) {
  if (!JobFolder::holds_job(root)) {
    static_cast<void>(JobFolder::create(root, text));
    return;
  }
  JobFolder folder = JobFolder::open(root);
  adopt_scene(folder, text, scene);
}

}  // namespace sluice

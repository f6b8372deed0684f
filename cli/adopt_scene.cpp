#include "cli/adopt_scene.hpp"

#include <fmt/format.h>

#include "cli/scene_file.hpp"
#include "cli/verbs.hpp"
#include "engine/scene/canonical.hpp"
#include "engine/scene/parse.hpp"

namespace sluice {

void adopt_scene(JobFolder& folder, const std::string& text, const Scene& scene) {
  const std::filesystem::path path = folder.paths().scene();
  const Scene present = job_scene_or_end(folder.scene_text(), path);
  if (identity_text(present) != identity_text(scene)) {
    throw CommandEnd(ExitCode::invalid_scene,
                     fmt::format("{} holds a run of another scene: choose another folder with "
                                 "--folder, or remove that one",
                                 folder.paths().root().string()));
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

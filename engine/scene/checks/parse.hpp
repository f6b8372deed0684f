#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/scene/model/parts.hpp"
#include "engine/scene/model/problems.hpp"
#include "engine/scene/model/scene.hpp"

namespace sluice {

/// A scene, or why there is none: `scene` holds a value exactly when `problems` is empty. What is
/// likely not meant, but can be run, is a warning.
struct ParseResult {
  std::optional<Scene> scene;
  std::vector<Problem> problems;
  std::vector<Problem> warnings;
};

/// Whether a scene that linear analysis calls unstable is a problem (stability.hpp). The stability
/// suite runs such scenes on purpose.
enum class StabilityCheck { refuse, skip };

/// Whose text a scene is. It decides what a scene means that names no scheme: one without was
/// written for a version that knew none and left out each term without a key, or means the
/// recommended scheme.
enum class SceneOrigin {
  user,   ///< recommended; a problem where that differs from what worked before there were schemes
  job,    ///< a job's folder, whose text names its scheme if it was made since: as before
  study,  ///< a study that was taken: as before where a user's is a problem, else recommended
};

/// Reads a scene, fills in every default and checks it. What is refused only since a job or a study
/// was taken, such as thin obstacles, is no problem of theirs. All problems are found at once, as
/// far as they do not follow from one another, and kMaxProblems of them are named. Nothing is
/// thrown for bad text, and nothing is allocated in proportion to what the scene asks for. `parts`
/// has the files that it names; what that throws is passed on.
[[nodiscard]] ParseResult parse_scene(std::string_view text,
                                      StabilityCheck stability = StabilityCheck::refuse,
                                      SceneOrigin origin = SceneOrigin::user,
                                      const SceneParts& parts = no_parts);
/// The same of a user's scene with parts.
[[nodiscard]] inline ParseResult parse_scene(std::string_view text, const SceneParts& parts) {
  return parse_scene(text, StabilityCheck::refuse, SceneOrigin::user, parts);
}

/// The scene.json of a job's folder. It was checked when the folder was made, and is not held
/// against stability again, so that no job becomes unreadable.
[[nodiscard]] ParseResult parse_job_scene(std::string_view text,
                                          const SceneParts& parts = no_parts);

/// The text of a scene as a job's folder keeps it: itself, but with the scheme named where it means
/// the recommended one without saying so, and with the SHA-256 of each mesh. Throws SceneError
/// where that makes it too long.
[[nodiscard]] std::string text_for_folder(const std::string& text,
                                          const SceneParts& parts = no_parts);

}  // namespace sluice

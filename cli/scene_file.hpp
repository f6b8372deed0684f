#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/store/files/scene_parts.hpp"

namespace sluice {

/// A scene with its text as a job's folder keeps it (text_for_folder).
struct SceneFile {
  std::string text;
  Scene scene;
  std::vector<Problem> warnings;
  std::vector<NamedPart> parts = {};  ///< the files that it names
};

/// The files that a scene of a user names: they lie beside it, or in this folder with a scene from
/// stdin.
[[nodiscard]] SceneParts parts_beside(const std::filesystem::path& scene);

/// A scene's text as it is, "-" from stdin. Throws CommandEnd: usage when it cannot be read,
/// invalid_scene when it is longer than a scene may be.
[[nodiscard]] std::string read_scene_bytes(const std::filesystem::path& path);

/// Reads and checks a scene, "-" from stdin. Prints every problem to stderr, one line each with its
/// JSON pointer, and throws CommandEnd(invalid_scene) when there are any.
[[nodiscard]] SceneFile read_scene(const std::filesystem::path& path);

/// The same for the scene in a job's folder.
[[nodiscard]] Scene job_scene_or_end(std::string_view text, const std::filesystem::path& where);

/// "FILE: warning: /pointer: message", one line each.
[[nodiscard]] std::string warnings_text(const std::vector<Problem>& warnings,
                                        const std::string& where);

}  // namespace sluice

#pragma once

#include <filesystem>
#include <string>

namespace sluice {

/// A scene as the body of a request: as it is, or with the files that it names as a form.
struct SceneForm {
  std::string type;  ///< of its content
  std::string body;
};

/// `path` is the scene's, beside which its files lie; "-": in this folder. What is no valid scene
/// is for the service to say; a file that it names and that cannot be read is told here: throws
/// CommandEnd(invalid_scene).
[[nodiscard]] SceneForm form_of(const std::string& scene, const std::filesystem::path& path);

}  // namespace sluice

#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/scene/parse.hpp"
#include "engine/scene/scene.hpp"

namespace sluice {

/// A scene with the text it came from.
struct SceneFile {
  std::string text;
  Scene scene;
};

/// A scene's text as it is, "-" from stdin. Throws CommandEnd: usage when it cannot be read,
/// invalid_scene when it is longer than a scene may be.
[[nodiscard]] std::string read_scene_bytes(const std::filesystem::path& path);

/// Reads and checks a scene, "-" from stdin. Prints every problem to stderr, one line each with its
/// JSON pointer, and throws CommandEnd(invalid_scene) when there are any.
[[nodiscard]] SceneFile read_scene(const std::filesystem::path& path);

/// The same for a text that stands in `where`. What stands in a job's folder was checked when the
/// folder was made: StabilityCheck::skip there, so that no job becomes unreadable.
[[nodiscard]] Scene parse_scene_or_end(std::string_view text, const std::filesystem::path& where,
                                       StabilityCheck stability);

}  // namespace sluice

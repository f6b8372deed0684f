#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/scene/model/parts.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/store/disk/file_system.hpp"

namespace sluice {

/// A file that a scene names, with its name.
struct NamedPart {
  std::string name;
  std::string bytes;
};

/// The parts of a scene that lie beside it: in a job's folder, where no link is followed, or where
/// a user's scene lies. Each is read once; one that cannot be read says why.
[[nodiscard]] SceneParts parts_in(const std::filesystem::path& folder, Links links);

/// Those that came with a scene, as with a request. `how_to_send` ends the message for others.
[[nodiscard]] SceneParts parts_from(std::vector<NamedPart> parts, std::string how_to_send);

/// The parts that a scene names, each once, in the order of their names. They have been read
/// before, when the scene was.
[[nodiscard]] std::vector<NamedPart> parts_of(const Scene& scene, const SceneParts& parts);

}  // namespace sluice

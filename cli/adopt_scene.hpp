#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/scene/model/scene.hpp"
#include "engine/store/files/job_folder.hpp"
#include "engine/store/files/scene_parts.hpp"

namespace sluice {

/// Puts a scene's text into a job's folder that holds this very scene, or one that only ends at
/// another time or has another name or reference. Throws CommandEnd(invalid_scene) for another.
void adopt_scene(JobFolder& folder, const std::string& text, const Scene& scene);

/// Makes the folder of a job with this scene and its parts, or adopts it where there is one. The
/// folder's lock is free again afterwards.
void prepare_folder(const std::filesystem::path& root, const std::string& text, const Scene& scene,
                    const std::vector<NamedPart>& parts);

}  // namespace sluice

#pragma once

#include "engine/scene/model/parts.hpp"
#include "engine/scene/model/problems.hpp"
#include "engine/scene/model/scene.hpp"

namespace sluice {

/// Makes the surfaces of a scene's heights and meshes, and checks them: heights above their base;
/// files that are there, read well, are the ones that `sha256` names, and are closed. Triangles
/// that all face inwards are turned round, which is a warning. Fills in `sha256`. What has problems
/// already is left out.
void make_surfaces(Scene& scene, const SceneParts& parts, Problems& problems, Problems& warnings);

}  // namespace sluice

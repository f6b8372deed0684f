#pragma once

#include "engine/scene/model/problems.hpp"
#include "engine/scene/model/scene.hpp"

namespace sluice {

/// check_solids() of a scene of space: obstacles that are too thin between two places that fluid
/// has room at are problems, those with few particles across are warnings. Looked at is each
/// obstacle by itself, at places spread over its faces; slits between two are not looked for.
void check_solids_in_space(const Scene& scene, Problems& problems, Problems& warnings);

}  // namespace sluice

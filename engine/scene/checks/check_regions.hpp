#pragma once

#include "engine/scene/model/problems.hpp"
#include "engine/scene/model/scene.hpp"

namespace sluice {

/// Warns of regions of fluid with a slit between them that is narrower than a spacing: neither
/// joined nor apart, they fall together at the start.
void warn_of_gaps(const Scene& scene, Problems& warnings);

}  // namespace sluice

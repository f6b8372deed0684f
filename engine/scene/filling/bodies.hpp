#pragma once

#include <cstddef>
#include <vector>

#include "engine/scene/model/scene.hpp"

namespace sluice {

/// Regions that touch, as indices in the scene's order.
using Body = std::vector<std::size_t>;

/// The regions of a scene by bodies: those whose bounds come within a spacing are in one.
[[nodiscard]] std::vector<Body> bodies(const Scene& scene);

}  // namespace sluice

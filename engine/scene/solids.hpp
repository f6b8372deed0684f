#pragma once

#include "engine/scene/scene.hpp"

namespace sluice {

/// How deep in a solid a particle may be before it has leaked, in spacings: there the first row of
/// dummy particles stands, and behind it they push on instead of back.
inline constexpr double kDepthInSolid = 0.5;

/// The scene's method with what its solids fill: the tank's walls, obstacles, and the gate while it
/// is there.
[[nodiscard]] Method method_with_solids(const Scene& scene);

}  // namespace sluice

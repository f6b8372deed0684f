#pragma once

#include "engine/scene/model/scene.hpp"

namespace sluice {

/// How deep in a solid a particle may be before it has leaked, m, where the solid is so thick: one
/// spacing, beyond the first row of dummy particles, for in a hard impact some come as far as that
/// row and are thrown back. Less where it is thinner than some three spacings, so that its middle
/// is deep.
[[nodiscard]] double allowed_depth(double thickness, double spacing);

/// The scene's domain with what its solids fill: the tank's walls, obstacles, and the gate while it
/// is there.
[[nodiscard]] FlowDomain domain_with_solids(const Scene& scene);

}  // namespace sluice

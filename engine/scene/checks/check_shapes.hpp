#pragma once

#include <string>

#include "engine/scene/format/written_scene.hpp"
#include "engine/scene/model/problems.hpp"

namespace sluice {

// The checks that are about places and sizes. Each leaves out what has problems already.

/// Polygons are simple and have an area, also those of prisms; cylinders have a height.
void check_insides(const Scene& scene, Problems& problems);
/// Shapes and the tank are at least one spacing wide and high.
void check_sizes(const Scene& scene, Problems& problems);
/// Fluid and obstacles lie inside the tank.
void check_tank(const Scene& scene, Problems& problems);
/// The gate stands in a tank, beside all obstacles. `scene` is resolved.
void check_gate(const Scene& scene, Problems& problems);
/// The domain is a box, not vast, and holds the tank with its walls, else every shape. `scene` is
/// resolved; `document` tells whether the domain was given.
void check_domain(const Scene& scene, const WrittenScene& written, Problems& problems);

/// "(0, 0) to (2, 1) m".
[[nodiscard]] std::string show(const Box& box);

}  // namespace sluice

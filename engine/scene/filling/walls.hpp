#pragma once

#include <cstdint>
#include <vector>

#include "engine/scene/model/scene.hpp"

namespace sluice {

/// Layers of dummy particles behind a solid surface: as many as hold the kernel's support, at least
/// three.
[[nodiscard]] std::int64_t wall_layers(const Method& method);

/// walls_around() the tank.
[[nodiscard]] std::vector<Vec> tank_walls(const Tank& tank, const Method& method);

/// How many tank_walls() makes; a double, so that an absurd tank gives a large number.
[[nodiscard]] double count_tank_walls(const Tank& tank, const Method& method);

/// What the gate of a scene fills: wall_layers() spacings to the right of its x, from the floor up,
/// from side to side. Of a scene without one, or without a tank: nothing is promised.
[[nodiscard]] Shape gate_body(const Scene& scene);

/// All that stands in the tank at the start: the obstacles, then the gate.
[[nodiscard]] std::vector<Shape> solid_bodies(const Scene& scene);

/// All dummy particles of a scene, m: the tank's, then those of its solid bodies, which are those
/// of obstacle_walls() but for polygons that fluid touches whose lattice does not fit it: theirs
/// are face_layers(). No fluid is made.
[[nodiscard]] std::vector<Vec> scene_walls(const Scene& scene);

/// walls_of_solids() of obstacles, all in cells.
[[nodiscard]] std::vector<Vec> obstacle_walls(const std::vector<Shape>& obstacles,
                                              const Method& method);

}  // namespace sluice

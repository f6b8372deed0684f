#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "engine/scene/geometry/tank_room.hpp"

namespace sluice {

/// How many layers of dummy particles stand behind a solid surface, and how far apart.
struct WallLayers {
  double spacing = 0.0;  ///< dx, m
  std::int64_t count = 0;
};

/// Dummy particles around a tank, m: layer k = 0, 1, ... lies (k + 1/2) dx outside the floor, the
/// sides and, unless the top is open, the lid; corners included. Along a wall of length L the
/// particles are L/n apart with n = round(L/dx), so that a whole number fits.
template <int Dim>
[[nodiscard]] std::vector<VecN<Dim>> walls_around(const TankRoomN<Dim>& room,
                                                  const WallLayers& layers);

/// How many walls_around() makes; a double, so that an absurd tank gives a large number.
template <int Dim>
[[nodiscard]] double count_walls_around(const TankRoomN<Dim>& room, const WallLayers& layers);

/// The dummy particles of solid i, m, where they do not lie in its cells.
template <int Dim>
using OwnWallsN = std::function<std::optional<std::vector<VecN<Dim>>>(std::size_t i)>;

/// Dummy particles of solids, m: at the cell centres of each, from a cell size stretched to fit a
/// cuboid and from dx otherwise, no deeper than the layers are many below the surface; or those
/// that `own` gives. Where solids overlap, the first one's particles stand.
template <int Dim>
[[nodiscard]] std::vector<VecN<Dim>> walls_of_solids(const std::vector<ShapeN<Dim>>& solids,
                                                     const WallLayers& layers,
                                                     const OwnWallsN<Dim>& own);

}  // namespace sluice

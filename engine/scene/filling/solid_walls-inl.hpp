#pragma once

#include <algorithm>
#include <cmath>

#include "engine/scene/filling/cells.hpp"
#include "engine/scene/filling/solid_walls.hpp"
#include "engine/scene/geometry/geometry.hpp"

namespace sluice {

template <int Dim>
std::vector<VecN<Dim>> walls_around(const TankRoomN<Dim>& room, const WallLayers& layers) {
  CellN<Dim> inside;
  for (int axis = 0; axis < Dim; ++axis) {
    inside[axis] = whole_cells(room.size[axis], layers.spacing);
  }
  // Stretched cells inside the tank, whole spacings outside it.
  const auto place = [&](int axis, std::int64_t i) {
    const double center = static_cast<double>(i) + 0.5;
    const auto cells = static_cast<double>(inside[axis]);
    if (i < 0) return center * layers.spacing;
    if (i < inside[axis]) return center * room.size[axis] / cells;
    return room.size[axis] + (center - cells) * layers.spacing;
  };

  std::vector<VecN<Dim>> walls;
  walls.reserve(static_cast<std::size_t>(count_walls_around(room, layers)));
  CellN<Dim> last = shifted<Dim>(inside, layers.count - 1);
  if (room.open_top) last[kUpAxis] = inside[kUpAxis] - 1;
  for_each_row<Dim>(shifted<Dim>({}, -layers.count), last, [&](CellN<Dim> cell) {
    bool meets_inside = true;
    for (int axis = 1; axis < Dim; ++axis) {
      meets_inside = meets_inside && cell[axis] >= 0 && cell[axis] < inside[axis];
    }
    for (; cell[0] <= last[0]; ++cell[0]) {
      if (meets_inside && cell[0] == 0) cell[0] = inside[0];
      VecN<Dim>& point = walls.emplace_back();
      for (int axis = 0; axis < Dim; ++axis) point[axis] = place(axis, cell[axis]);
    }
  });
  return walls;
}

template <int Dim>
double count_walls_around(const TankRoomN<Dim>& room, const WallLayers& layers) {
  const auto deep = static_cast<double>(layers.count);
  const auto cells = [&](int axis) {
    return std::max(1.0, std::round(room.size[axis] / layers.spacing));
  };
  // Axis by axis: what surrounds the room along the axes so far, and all of it with its inside.
  double around = 2 * deep;
  double whole = cells(0) + 2 * deep;
  for (int axis = kUpAxis + 1; axis < Dim; ++axis) {
    around = 2 * deep * whole + around * cells(axis);
    whole *= cells(axis) + 2 * deep;
  }
  const double floor = deep * whole;
  return floor * (room.open_top ? 1 : 2) + around * cells(kUpAxis);
}

template <int Dim>
std::vector<VecN<Dim>> walls_of_solids(const std::vector<ShapeN<Dim>>& solids,
                                       const WallLayers& layers, const OwnWallsN<Dim>& own) {
  std::vector<VecN<Dim>> walls;
  std::vector<std::function<bool(const VecN<Dim>&)>> earlier;
  const auto add = [&](const VecN<Dim>& point) {
    const bool taken = std::any_of(earlier.begin(), earlier.end(),
                                   [&](const auto& holds) { return holds(point); });
    if (!taken) walls.push_back(point);
  };
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const ShapeN<Dim>& solid = solids[i];
    if (const auto particles = own(i)) {
      for (const VecN<Dim>& point : *particles) add(point);
      earlier.emplace_back([&solid](const VecN<Dim>& point) { return contains(solid, point); });
      continue;
    }
    CellSetN<Dim> cells(solid, layers.spacing, CellFit::stretched);
    cells.for_each([&](const VecN<Dim>& center, const CellN<Dim>& cell) {
      if (!cells.is_deep(cell, layers.count)) add(center);
    });
    earlier.emplace_back(
        [cells = std::move(cells)](const VecN<Dim>& point) { return cells.covers(point); });
  }
  return walls;
}

}  // namespace sluice

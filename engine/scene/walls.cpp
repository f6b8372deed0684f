#include "engine/scene/walls.hpp"

#include <algorithm>
#include <cmath>

#include "engine/scene/cells.hpp"

namespace sluice {

std::int64_t wall_layers(const Method& method) {
  // The quotient of 3 dx and dx may come out a rounding above 3.
  const double layers = std::ceil(method.support() / method.spacing - 1e-9);
  return std::max<std::int64_t>(3, static_cast<std::int64_t>(layers));
}

std::vector<Vec> tank_walls(const Tank& tank, const Method& method) {
  const std::int64_t layers = wall_layers(method);
  const std::int64_t columns = whole_cells(tank.width, method.spacing);
  const std::int64_t rows = whole_cells(tank.height, method.spacing);

  // Coordinate of row or column i: stretched cells inside the tank, whole spacings outside it.
  const auto place = [&](std::int64_t i, std::int64_t cells, double length) {
    const double center = static_cast<double>(i) + 0.5;
    if (i < 0) return center * method.spacing;
    if (i < cells) return center * length / static_cast<double>(cells);
    return length + (center - static_cast<double>(cells)) * method.spacing;
  };

  std::vector<Vec> walls;
  walls.reserve(static_cast<std::size_t>(count_tank_walls(tank, method)));
  const std::int64_t top = tank.open_top ? rows : rows + layers;
  for (std::int64_t row = -layers; row < top; ++row) {
    for (std::int64_t column = -layers; column < columns + layers; ++column) {
      if (row >= 0 && row < rows && column == 0) column = columns;  // over the inside
      walls.emplace_back(place(column, columns, tank.width), place(row, rows, tank.height));
    }
  }
  return walls;
}

double count_tank_walls(const Tank& tank, const Method& method) {
  const auto layers = static_cast<double>(wall_layers(method));
  const double columns = std::max(1.0, std::round(tank.width / method.spacing));
  const double rows = std::max(1.0, std::round(tank.height / method.spacing));
  const double floor = layers * (columns + 2 * layers);
  return floor * (tank.open_top ? 1 : 2) + 2 * layers * rows;
}

Rectangle gate_body(const Gate& gate, const Method& method) {
  const double thickness = static_cast<double>(wall_layers(method)) * method.spacing;
  return {Vec(gate.x, 0.0), Vec(thickness, gate.height)};
}

std::vector<Shape> solid_bodies(const Scene& scene) {
  std::vector<Shape> solids = scene.obstacles;
  if (scene.gate) solids.emplace_back(gate_body(*scene.gate, scene.method));
  return solids;
}

std::vector<Vec> scene_walls(const Scene& scene) {
  std::vector<Vec> walls;
  if (scene.tank) walls = tank_walls(*scene.tank, scene.method);
  const std::vector<Vec> solid = obstacle_walls(solid_bodies(scene), scene.method);
  walls.insert(walls.end(), solid.begin(), solid.end());
  return walls;
}

std::vector<Vec> obstacle_walls(const std::vector<Shape>& obstacles, const Method& method) {
  const std::int64_t layers = wall_layers(method);
  std::vector<Vec> walls;
  std::vector<CellSet> earlier;
  for (const Shape& obstacle : obstacles) {
    CellSet cells(obstacle, method.spacing, CellFit::stretched);
    cells.for_each([&](const Vec& center, std::int64_t row, std::int64_t column) {
      if (cells.is_deep(row, column, layers)) return;
      const bool taken = std::any_of(earlier.begin(), earlier.end(),
                                     [&](const CellSet& other) { return other.covers(center); });
      if (!taken) walls.push_back(center);
    });
    earlier.push_back(std::move(cells));
  }
  return walls;
}

}  // namespace sluice

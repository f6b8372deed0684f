#include "engine/scene/filling/walls.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "engine/scene/filling/cells.hpp"
#include "engine/scene/filling/face_layers.hpp"
#include "engine/scene/filling/lattice_fit.hpp"
#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

/// Whether a place is solid but for one obstacle. A gate leaves.
bool is_covered(const Scene& scene, std::size_t but, const Vec& point) {
  if (scene.tank) {
    const Tank& tank = *scene.tank;
    if (point.x() < 0.0 || point.x() > tank.width || point.y() < 0.0) return true;
    if (!tank.open_top && point.y() > tank.height) return true;
  }
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    if (i != but && contains(scene.obstacles[i], point)) return true;
  }
  return false;
}

std::optional<Polygon> straight_outline_of(const Shape& shape) {
  if (const auto* polygon = std::get_if<Polygon>(&shape)) return *polygon;
  const auto* box = std::get_if<Rectangle>(&shape);
  if (box == nullptr) return std::nullopt;
  const Vec across(box->size.x(), 0.0);
  return Polygon{{box->corner, box->corner + across, box->corner + box->size,
                  box->corner + box->size - across}};
}

/// The layers of obstacle i, or nothing where its dummy particles lie in cells.
using Layers = std::function<std::optional<std::vector<Vec>>(std::size_t i)>;

std::vector<Vec> solid_walls(const std::vector<Shape>& solids, const Method& method,
                             const Layers& by_faces) {
  const std::int64_t layers = wall_layers(method);
  std::vector<Vec> walls;
  std::vector<std::function<bool(const Vec&)>> earlier;
  const auto add = [&](const Vec& point) {
    const bool taken = std::any_of(earlier.begin(), earlier.end(),
                                   [&](const auto& holds) { return holds(point); });
    if (!taken) walls.push_back(point);
  };
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const Shape& solid = solids[i];
    if (const auto particles = by_faces(i)) {
      for (const Vec& point : *particles) add(point);
      earlier.emplace_back([&solid](const Vec& point) { return contains(solid, point); });
      continue;
    }
    CellSet cells(solid, method.spacing, CellFit::stretched);
    cells.for_each([&](const Vec& center, std::int64_t row, std::int64_t column) {
      if (!cells.is_deep(row, column, layers)) add(center);
    });
    earlier.emplace_back(
        [cells = std::move(cells)](const Vec& point) { return cells.covers(point); });
  }
  return walls;
}

}  // namespace

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
  const std::vector<Shape> solids = solid_bodies(scene);
  const std::vector<bool> beside = beside_misfits(scene);
  const auto layers = [&](std::size_t i) -> std::optional<std::vector<Vec>> {
    if (i >= beside.size() || !beside[i]) return std::nullopt;
    const std::optional<Polygon> polygon = straight_outline_of(solids[i]);
    if (!polygon) return std::nullopt;
    return face_layers(*polygon, scene.method,
                       [&](const Vec& point) { return is_covered(scene, i, point); });
  };
  const std::vector<Vec> solid = solid_walls(solids, scene.method, layers);
  walls.insert(walls.end(), solid.begin(), solid.end());
  return walls;
}

std::vector<Vec> obstacle_walls(const std::vector<Shape>& obstacles, const Method& method) {
  return solid_walls(obstacles, method, [](std::size_t) { return std::nullopt; });
}

}  // namespace sluice

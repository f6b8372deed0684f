#include "engine/scene/filling/walls.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/scene/filling/face_layers.hpp"
#include "engine/scene/filling/lattice_fit.hpp"
#include "engine/scene/filling/solid_walls.hpp"
#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

/// Whether a place is solid but for one obstacle. A gate leaves.
bool is_covered(const Scene& scene, std::size_t but, const Vec& point) {
  if (scene.tank) {
    const TankRoom tank = room_of(*scene.tank);
    if (tank.aside(point) > 0.0 || point[kUpAxis] < 0.0) return true;
    if (!tank.open_top && tank.over(point) > 0.0) return true;
  }
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    if (i != but && contains(scene.obstacles[i], point)) return true;
  }
  return false;
}

std::optional<Polygon> straight_outline_of(const Shape& shape) {
  if (const auto* polygon = std::get_if<Polygon>(&shape)) return *polygon;
  if (const auto* box = std::get_if<Rectangle>(&shape)) return as_polygon(*box);
  return std::nullopt;
}

WallLayers layers_of(const Method& method) { return {method.spacing, wall_layers(method)}; }

}  // namespace

std::int64_t wall_layers(const Method& method) {
  // The quotient of 3 dx and dx may come out a rounding above 3.
  const double layers = std::ceil(method.support() / method.spacing - 1e-9);
  return std::max<std::int64_t>(3, static_cast<std::int64_t>(layers));
}

std::vector<Vec> tank_walls(const Tank& tank, const Method& method) {
  return walls_around(room_of(tank), layers_of(method));
}

double count_tank_walls(const Tank& tank, const Method& method) {
  return count_walls_around(room_of(tank), layers_of(method));
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
  const std::vector<Vec> solid = walls_of_solids<kDim>(solids, layers_of(scene.method), layers);
  walls.insert(walls.end(), solid.begin(), solid.end());
  return walls;
}

std::vector<Vec> obstacle_walls(const std::vector<Shape>& obstacles, const Method& method) {
  return walls_of_solids<kDim>(obstacles, layers_of(method),
                               [](std::size_t) { return std::nullopt; });
}

}  // namespace sluice

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

/// Whether a place of the plane is solid but for one obstacle. A gate leaves.
bool is_covered(const Scene& scene, std::size_t but, const Vec2& point) {
  if (scene.tank) {
    const TankRoomN<2> tank = room_of<2>(*scene.tank);
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

template <int Dim>
std::vector<Vec> as_any(const std::vector<VecN<Dim>>& points) {
  return {points.begin(), points.end()};
}

/// Layers along the faces of an obstacle of the plane that fluid touches whose lattice does not fit
/// it.
std::optional<std::vector<Vec2>> face_layers_of(const Scene& scene, const std::vector<bool>& beside,
                                                std::size_t i) {
  if (i >= beside.size() || !beside[i]) return std::nullopt;
  const std::optional<Polygon> polygon = straight_outline_of(scene.obstacles[i]);
  if (!polygon) return std::nullopt;
  return face_layers(*polygon, scene.method,
                     [&](const Vec2& point) { return is_covered(scene, i, point); });
}

template <int Dim>
std::vector<Vec> solid_walls(const Scene& scene) {
  // Faces have layers of their own in the plane alone.
  const std::vector<bool> beside = Dim == 2 ? beside_misfits(scene) : std::vector<bool>{};
  const auto own = [&](std::size_t i) -> std::optional<std::vector<VecN<Dim>>> {
    if constexpr (Dim == 2) return face_layers_of(scene, beside, i);
    return std::nullopt;
  };
  return as_any<Dim>(
      walls_of_solids<Dim>(shapes_as<Dim>(solid_bodies(scene)), layers_of(scene.method), own));
}

}  // namespace

std::int64_t wall_layers(const Method& method) {
  // The quotient of 3 dx and dx may come out a rounding above 3.
  const double layers = std::ceil(method.support() / method.spacing - 1e-9);
  return std::max<std::int64_t>(3, static_cast<std::int64_t>(layers));
}

std::vector<Vec> tank_walls(const Tank& tank, const Method& method) {
  return in_dimensions(method.dimensions(), [&]<int Dim>() {
    return as_any<Dim>(walls_around(room_of<Dim>(tank), layers_of(method)));
  });
}

double count_tank_walls(const Tank& tank, const Method& method) {
  return in_dimensions(method.dimensions(), [&]<int Dim>() {
    return count_walls_around(room_of<Dim>(tank), layers_of(method));
  });
}

Shape gate_body(const Scene& scene) {
  const Gate& gate = *scene.gate;
  const double thickness = static_cast<double>(wall_layers(scene.method)) * scene.method.spacing;
  if (scene.dimensions() == 2) return Rectangle{Vec2(gate.x, 0.0), Vec2(thickness, gate.height)};
  return Cuboid<3>{Vec3(gate.x, 0.0, 0.0),
                   Vec3(thickness, gate.height, scene.tank->depth.value_or(0.0))};
}

std::vector<Shape> solid_bodies(const Scene& scene) {
  std::vector<Shape> solids = scene.obstacles;
  if (scene.gate) solids.push_back(gate_body(scene));
  return solids;
}

std::vector<Vec> scene_walls(const Scene& scene) {
  std::vector<Vec> walls;
  if (scene.tank) walls = tank_walls(*scene.tank, scene.method);
  const std::vector<Vec> solid =
      in_dimensions(scene.dimensions(), [&]<int Dim>() { return solid_walls<Dim>(scene); });
  walls.insert(walls.end(), solid.begin(), solid.end());
  return walls;
}

std::vector<Vec> obstacle_walls(const std::vector<Shape>& obstacles, const Method& method) {
  return in_dimensions(method.dimensions(), [&]<int Dim>() {
    return as_any<Dim>(walls_of_solids<Dim>(shapes_as<Dim>(obstacles), layers_of(method),
                                            [](std::size_t) { return std::nullopt; }));
  });
}

}  // namespace sluice

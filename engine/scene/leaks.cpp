#include "engine/scene/leaks.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "engine/scene/geometry.hpp"

namespace sluice {
namespace {

/// A solid with the box that holds all that is deep in it.
struct Solid {
  Shape shape;
  Box box;
  double depth;  ///< m
};

/// The box without a margin on all sides.
Box inner(Box box, double margin) {
  box.min.array() += margin;
  box.max.array() -= margin;
  return box;
}

bool is_deep(const LiftedWall& gate, const Vec& place, double time, double depth) {
  Box standing = gate.place;
  standing.min.y() += gate.speed * time;
  return inner(standing, depth).contains(place);
}

void add_tank(const Tank& tank, double depth, Method& method) {
  method.room = {Vec::Constant(-depth), Vec(tank.width, tank.height).array() + depth};
  if (!tank.open_top) return;
  method.room.max.y() = std::numeric_limits<double>::infinity();
  method.walls_reach = tank.height - depth;
}

}  // namespace

double allowed_depth(const Shape& solid, double spacing) {
  // Half of the thickness of a long plate.
  const double half_thickness = area(solid) / perimeter(solid);
  return std::clamp(0.6 * half_thickness, 0.4 * spacing, spacing);
}

Method method_with_solids(const Scene& scene) {
  Method method = scene.method;
  const double depth = method.spacing;
  if (scene.tank) add_tank(*scene.tank, depth, method);
  std::vector<Solid> solids;
  for (const Shape& shape : scene.obstacles) {
    const double here = allowed_depth(shape, method.spacing);
    solids.push_back({shape, inner(bounds(shape), here), here});
  }
  if (solids.empty() && !method.lifted_wall) return method;
  method.in_solid = [solids = std::move(solids), gate = method.lifted_wall, depth](const Vec& place,
                                                                                   double time) {
    if (gate && is_deep(*gate, place, time, depth)) return true;
    return std::any_of(solids.begin(), solids.end(), [&](const Solid& solid) {
      return solid.box.contains(place) && signed_distance(solid.shape, place) < -solid.depth;
    });
  };
  return method;
}

}  // namespace sluice

#include "engine/scene/geometry/open_fraction.hpp"

#include <algorithm>

#include "engine/scene/geometry/directions.hpp"
#include "engine/scene/geometry/geometry.hpp"
#include "engine/scene/geometry/tank_room.hpp"
#include "engine/sph/kernel/kernel.hpp"

namespace sluice {
namespace {

// Spheres and rays cut a straight wall at another place each; a square grid would meet it all along
// a row. In the plane no ray lies on an axis, and a quarter of them in each quadrant: a corner is
// exact. In space they are enough for half a percent.
constexpr int kSpheres = 60;
template <int Dim>
constexpr int kRays = Dim == 2 ? 180 : 1440;

/// Above the rim of an open tank all is open.
template <int Dim>
bool in_wall(const TankRoomN<Dim>& tank, const VecN<Dim>& point) {
  if (tank.over(point) >= 0.0) return !tank.open_top;
  return !tank.between_sides(point) || point[kUpAxis] <= 0.0;
}

/// The obstacles that come within `reach` of a point, by their bounds.
template <int Dim>
std::vector<ShapeN<Dim>> obstacles_near(const Scene& scene, const VecN<Dim>& point, double reach) {
  std::vector<ShapeN<Dim>> near;
  for (const ShapeN<Dim>& solid : shapes_as<Dim>(scene.obstacles)) {
    if (grown(bounds(solid), reach).contains(point)) near.push_back(solid);
  }
  return near;
}

}  // namespace

OpenFraction::OpenFraction(const Scene& scene, const Vec& point, double h)
    : gate_(scene.domain.gate) {
  in_dimensions(scene.dimensions(), [&]<int Dim>() { integrate<Dim>(scene, point, h); });
}

template <int Dim>
void OpenFraction::integrate(const Scene& scene, const VecN<Dim>& point, double h) {
  using Shapes = std::vector<ShapeN<Dim>>;
  const Shapes solids = obstacles_near<Dim>(scene, point, scene.method.support_ratio() * h);
  const std::optional<TankRoomN<Dim>> tank = room_of<Dim>(scene);
  const auto is_open = [&](const VecN<Dim>& place) {
    return (!tank || !in_wall(*tank, place)) &&
           std::none_of(solids.begin(), solids.end(),
                        [&](const ShapeN<Dim>& solid) { return contains(solid, place); });
  };
  const std::vector<VecN<Dim>> rays = directions<Dim>(kRays<Dim>, 0.5);
  double whole = 0.0;
  for (int sphere = 0; sphere < kSpheres; ++sphere) {
    const double r = scene.method.support_ratio() * (sphere + 0.5) / kSpheres;
    const double weight =
        times_power<Dim - 1>(1.0, r) * kernel_value<Dim>(scene.method.kernel, r * r);
    for (const VecN<Dim>& ray : rays) {
      const VecN<Dim> place = point + h * r * ray;
      whole += weight;
      if (!is_open(place)) continue;
      if (gate_ && gate_->place.contains(place)) {
        held_.push_back({place, weight});
      } else {
        without_gate_ += weight;
      }
    }
  }
  without_gate_ /= whole;
  for (Held& one : held_) one.weight /= whole;
}

double OpenFraction::at(double time) const {
  double share = without_gate_;
  for (const Held& one : held_) {
    if (gate_->has_passed(one.place, time)) share += one.weight;
  }
  return share;
}

}  // namespace sluice

#include "engine/scene/geometry/open_fraction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/scene/geometry/geometry.hpp"
#include "engine/sph/kernel/kernel.hpp"

namespace sluice {
namespace {

// Rings and rays cut a straight wall at another place each; a square grid would meet it all along a
// row. No ray lies on an axis, and a quarter of them in each quadrant: a corner is exact.
constexpr int kRings = 60;
constexpr int kRays = 180;

/// Above the rim of an open tank all is open.
bool in_wall(const Tank& tank, const Vec& point) {
  if (point.y() >= tank.height) return !tank.open_top;
  return point.x() <= 0.0 || point.x() >= tank.width || point.y() <= 0.0;
}

/// The obstacles that come within `reach` of a point, by their bounds.
std::vector<Shape> obstacles_near(const Scene& scene, const Vec& point, double reach) {
  std::vector<Shape> near;
  for (const Shape& solid : scene.obstacles) {
    if (grown(bounds(solid), reach).contains(point)) near.push_back(solid);
  }
  return near;
}

}  // namespace

OpenFraction::OpenFraction(const Scene& scene, const Vec& point, double h)
    : gate_(scene.domain.gate) {
  const std::vector<Shape> solids = obstacles_near(scene, point, scene.method.support_ratio() * h);
  const auto is_open = [&](const Vec& place) {
    return (!scene.tank || !in_wall(*scene.tank, place)) &&
           std::none_of(solids.begin(), solids.end(),
                        [&](const Shape& solid) { return contains(solid, place); });
  };
  double whole = 0.0;
  for (int ring = 0; ring < kRings; ++ring) {
    const double r = scene.method.support_ratio() * (ring + 0.5) / kRings;
    const double weight = r * kernel_value(scene.method.kernel, r * r);
    for (int ray = 0; ray < kRays; ++ray) {
      const double angle = 2.0 * std::numbers::pi * (ray + 0.5) / kRays;
      const Vec place = point + h * r * Vec(std::cos(angle), std::sin(angle));
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

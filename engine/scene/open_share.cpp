#include "engine/scene/open_share.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/scene/geometry.hpp"
#include "engine/sph/kernel.hpp"

namespace sluice {
namespace {

// Rings and rays cut a straight wall at another place each; a square grid would meet it all along a
// row. No ray lies on an axis, and a quarter of them in each quadrant: a corner is exact.
constexpr int kRings = 60;
constexpr int kRays = 180;

bool in_tank(const Tank& tank, const Vec& point) {
  return point.x() > 0.0 && point.x() < tank.width && point.y() > 0.0 &&
         (tank.open_top || point.y() < tank.height);
}

bool is_open(const Scene& scene, const Vec& point) {
  return (!scene.tank || in_tank(*scene.tank, point)) &&
         std::none_of(scene.obstacles.begin(), scene.obstacles.end(),
                      [&](const Shape& solid) { return contains(solid, point); });
}

}  // namespace

OpenShare::OpenShare(const Scene& scene, const Vec& point, double h)
    : gate_(scene.method.lifted_wall) {
  double whole = 0.0;
  for (int ring = 0; ring < kRings; ++ring) {
    const double r = scene.method.support_ratio() * (ring + 0.5) / kRings;
    const double weight = r * kernel_value(scene.method.kernel, r * r);
    for (int ray = 0; ray < kRays; ++ray) {
      const double angle = 2.0 * std::numbers::pi * (ray + 0.5) / kRays;
      const Vec place = point + h * r * Vec(std::cos(angle), std::sin(angle));
      whole += weight;
      if (!is_open(scene, place)) continue;
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

double OpenShare::at(double time) const {
  double share = without_gate_;
  for (const Held& one : held_) {
    if (gate_->has_passed(one.place, time)) share += one.weight;
  }
  return share;
}

}  // namespace sluice

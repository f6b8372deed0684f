#include "engine/scene/geometry/geometry.hpp"

#include <cmath>

namespace sluice {

Vec velocity_at(const FluidRegion& region, const Vec& point) {
  if (!region.strain_rate && !region.rotation_rate) return region.velocity;
  const Vec arm = point - bounds(region.shape).middle();
  const double a = region.strain_rate.value_or(0.0);
  const double w = region.rotation_rate.value_or(0.0);
  Vec velocity = region.velocity;
  velocity.head<2>() += Vec2(a * arm.x() - w * arm.y(), w * arm.x() - a * arm.y());
  return velocity;
}

double greatest_speed(const FluidRegion& region) {
  const double rate =
      std::abs(region.strain_rate.value_or(0.0)) + std::abs(region.rotation_rate.value_or(0.0));
  return region.velocity.norm() + rate * 0.5 * bounds(region.shape).size().norm();
}

}  // namespace sluice

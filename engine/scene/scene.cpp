#include "engine/scene/scene.hpp"

#include <cmath>

#include "engine/scene/geometry.hpp"

namespace sluice {

Vec FluidRegion::velocity_at(const Vec& point) const {
  if (!strain_rate && !rotation_rate) return velocity;
  const Box box = bounds(shape);
  const Vec arm = point - 0.5 * (box.min + box.max);
  const double a = strain_rate.value_or(0.0);
  const double w = rotation_rate.value_or(0.0);
  return velocity + Vec(a * arm.x() - w * arm.y(), w * arm.x() - a * arm.y());
}

double FluidRegion::greatest_speed() const {
  const double rate = std::abs(strain_rate.value_or(0.0)) + std::abs(rotation_rate.value_or(0.0));
  return velocity.norm() + rate * 0.5 * bounds(shape).size().norm();
}

}  // namespace sluice

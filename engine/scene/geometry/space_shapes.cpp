#include "engine/scene/geometry/space_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/scene/geometry/plane_shapes.hpp"
#include "engine/scene/geometry/shapes.hpp"

namespace sluice {
namespace {

/// A vector in two: along the axis of a cylinder, and across it.
struct Parts {
  double along;
  VecN<3> across;
};

Parts parts_of(const VecN<3>& vector, const Cylinder& s) {
  const VecN<3> unit = s.axis.normalized();
  const double along = unit.dot(vector);
  return {along, vector - along * unit};
}

/// Distances from the two parts that a body is of: along and across an axis.
VecN<2> beyond(const Cylinder& s, const VecN<3>& point) {
  const Parts from_base = parts_of(point - s.base, s);
  const double half = s.axis.norm() / 2;
  return {std::abs(from_base.along - half) - half, from_base.across.norm() - s.radius};
}
double beyond_ends(const Prism& s, double z) { return std::max(s.z - z, z - s.z - s.depth); }

}  // namespace

BoxN<3> bounds(const Cylinder& s) {
  BoxN<3> box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = -farthest_along(s, -VecN<3>::Unit(axis));
    box.max[axis] = farthest_along(s, VecN<3>::Unit(axis));
  }
  return box;
}
BoxN<3> bounds(const Prism& s) {
  const BoxN<2> section = bounds(s.section);
  return {{section.min.x(), section.min.y(), s.z},
          {section.max.x(), section.max.y(), s.z + s.depth}};
}

double measure(const Cylinder& s) {
  return measure(Circle{VecN<2>::Zero(), s.radius}) * s.axis.norm();
}
double measure(const Prism& s) { return measure(s.section) * s.depth; }

double perimeter(const Cylinder& s) {
  return 2 * std::numbers::pi * s.radius * (s.radius + s.axis.norm());
}
double perimeter(const Prism& s) { return 2 * measure(s.section) + perimeter(s.section) * s.depth; }

bool contains(const Cylinder& s, const VecN<3>& point) {
  return beyond(s, point).maxCoeff() <= 0.0;
}
bool contains(const Prism& s, const VecN<3>& point) {
  return beyond_ends(s, point.z()) <= 0.0 && contains(s.section, point.head<2>());
}

double signed_distance(const Cylinder& s, const VecN<3>& point) {
  return distance_from_all(beyond(s, point));
}
double signed_distance(const Prism& s, const VecN<3>& point) {
  return distance_from_all(
      VecN<2>(signed_distance(s.section, point.head<2>()), beyond_ends(s, point.z())));
}

double farthest_along(const Cylinder& s, const VecN<3>& direction) {
  return direction.dot(s.base) + std::max(0.0, direction.dot(s.axis)) +
         s.radius * parts_of(direction, s).across.norm();
}
double farthest_along(const Prism& s, const VecN<3>& direction) {
  const double rise = direction.z();
  return farthest_along(s.section, direction.head<2>()) +
         std::max(rise * s.z, rise * (s.z + s.depth));
}

std::vector<double> chords(const Cylinder& s, const VecN<3>& origin, const VecN<3>& direction) {
  const auto [along, from] = parts_of(origin - s.base, s);
  const auto [rate, way] = parts_of(direction, s);
  LinePart part;
  part.keep_between(-along, s.axis.norm() - along, rate);
  // abs(from + t way) = radius.
  const double square = way.squaredNorm();
  const double middle = square > 0.0 ? -from.dot(way) / square : 0.0;
  const double rest = s.radius * s.radius - (from + middle * way).squaredNorm();
  if (rest <= 0.0) return {};
  if (square > 0.0) {
    const double half = std::sqrt(rest / square);
    part.enter = std::max(part.enter, middle - half);
    part.leave = std::min(part.leave, middle + half);
  }
  return part.ends();
}

std::vector<double> chords(const Prism& s, const VecN<3>& origin, const VecN<3>& direction) {
  const VecN<2> from = origin.head<2>(), way = direction.head<2>();
  LinePart part;
  part.keep_between(s.z - origin.z(), s.z + s.depth - origin.z(), direction.z());
  if (way.isZero(0.0)) return contains(s.section, from) ? part.ends() : std::vector<double>{};
  std::vector<double> result;
  const std::vector<double> in_section = chords(s.section, from, way);
  for (std::size_t i = 0; i + 1 < in_section.size(); i += 2) {
    const double enter = std::max(part.enter, in_section[i]);
    const double leave = std::min(part.leave, in_section[i + 1]);
    if (enter < leave) result.insert(result.end(), {enter, leave});
  }
  return result;
}

}  // namespace sluice

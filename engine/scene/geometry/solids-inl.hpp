#pragma once

#include <algorithm>

#include "engine/scene/geometry/directions.hpp"
#include "engine/scene/geometry/geometry.hpp"
#include "engine/scene/geometry/solids.hpp"

namespace sluice {
namespace solids {

inline constexpr double kTiny = 1e-9;  // of the spacing: gaps and depths of rounding
template <int Dim>
inline constexpr int kDirections = Dim == 2 ? 32 : 96;

/// Whether a point lies in a shape, or as near to it as rounding goes.
template <class Any, class Point>
bool is_held(const Any& shape, const Point& point, double slack) {
  return contains(shape, point) || signed_distance(shape, point) <= slack;
}
/// A tree need not be gone through for what is far.
template <Meshed S>
bool is_held(const S& shape, const VecN<3>& point, double slack) {
  return surface_of(shape).contains(point) ||
         surface_of(shape).nearest(point, 2 * slack).distance <= slack;
}

/// Where one gets out of a shape on the shortest way, if that is known.
template <class Any, class Point>
std::optional<Point> way_out(const Any& /*shape*/, const Point& /*point*/) {
  return std::nullopt;
}
template <Meshed S>
std::optional<VecN<3>> way_out(const S& shape, const VecN<3>& point) {
  return surface_of(shape).nearest(point).place;
}

/// Whether a point is nearer to a shape than `distance` > 0, or in it.
template <class Any, class Point>
bool is_nearer(const Any& shape, const Point& point, double distance) {
  return signed_distance(shape, point) < distance;
}
/// The first order of an ellipse's distance is too coarse where its ends are sharp.
inline bool is_nearer(const Ellipse& shape, const VecN<2>& point, double distance) {
  const double first_order = signed_distance(shape, point);
  if (first_order <= 0.0) return first_order < distance;
  return distance_from_outside(shape, point) < distance;
}

template <Meshed S>
bool is_nearer(const S& shape, const VecN<3>& point, double distance) {
  return surface_of(shape).contains(point) ||
         surface_of(shape).nearest(point, distance).distance < distance;
}

}  // namespace solids

template <int Dim>
SolidsN<Dim>::SolidsN(const std::vector<ShapeN<Dim>>& obstacles, std::optional<TankRoomN<Dim>> tank,
                      double spacing)
    : tank_(tank),
      slack_(solids::kTiny * spacing),
      ways_(directions<Dim>(solids::kDirections<Dim>)) {
  // Across faces of cuboids the depth is then exact.
  for (int axis = 0; Dim == 3 && axis < Dim; ++axis) {
    ways_.emplace_back(Point::Unit(axis));
    ways_.emplace_back(-Point::Unit(axis));
  }
  for (const ShapeN<Dim>& shape : obstacles) {
    bodies_.push_back({shape, grown(bounds(shape), slack_)});
  }
}

template <int Dim>
double SolidsN<Dim>::depth_in_walls(const Point& p) const {
  return tank_ ? tank_->depth_in_walls(p) : 0.0;
}

template <int Dim>
bool SolidsN<Dim>::holds(const Point& p) const {
  if (depth_in_walls(p) > 0.0) return true;
  return std::any_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
    return body.box.contains(p) &&
           std::visit([&](const auto& s) { return solids::is_held(s, p, slack_); }, body.shape);
  });
}

template <int Dim>
bool SolidsN<Dim>::leaves_room(const Point& p, double margin) const {
  const double enough = margin - slack_;
  if (tank_ && !tank_->leaves_room(p, enough)) return false;
  return std::none_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
    const Point beyond = (body.box.min - p).cwiseMax(p - body.box.max);
    if (!(beyond.maxCoeff() < enough)) return false;
    return std::visit([&](const auto& s) { return solids::is_nearer(s, p, enough); }, body.shape);
  });
}

template <int Dim>
bool SolidsN<Dim>::gets_out(const Point& p, double depth) const {
  return std::any_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
    if (!body.box.contains(p)) return false;
    const std::optional<Point> out = std::visit(
        [&](const auto& s) -> std::optional<Point> { return solids::way_out(s, p); }, body.shape);
    if (!out) return false;
    const double length = (*out - p).norm();
    return length > slack_ && length <= depth && !holds(*out + 2 * slack_ / length * (*out - p));
  });
}

template <int Dim>
double SolidsN<Dim>::depth(const Point& p, double most) const {
  double deepest = depth_in_walls(p);
  for (const Body& body : bodies_) {
    if (body.box.contains(p)) deepest = std::max(deepest, -signed_distance(body.shape, p));
  }
  if (deepest >= most || !holds(p) || gets_out(p, deepest)) return deepest;
  double nearest = most;
  for (const Point& way : ways_) {
    if (nearest <= deepest) break;
    nearest = reach(p, way, nearest, most / 32).value_or(nearest);
  }
  return std::max(deepest, nearest);
}

template <int Dim>
std::optional<double> SolidsN<Dim>::reach(const Point& from, const Point& direction, double most,
                                          double step) const {
  const bool inside = holds(from);
  double near = 0.0;
  for (double far = step; near < most; near = far, far += step) {
    if (holds(from + far * direction) == inside) continue;
    double changed = far;
    while (changed - near > solids::kTiny * step) {
      const double middle = 0.5 * (near + changed);
      (holds(from + middle * direction) == inside ? near : changed) = middle;
    }
    return changed < most ? std::optional(changed) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace sluice

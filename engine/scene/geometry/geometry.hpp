#pragma once

#include <variant>
#include <vector>

#include "engine/scene/geometry/plane_shapes.hpp"
#include "engine/scene/geometry/shapes.hpp"
#include "engine/scene/model/scene.hpp"

namespace sluice {

// What every shape answers, of any number of dimensions: shapes.hpp has the bodies that are the
// same in all, plane_shapes.hpp those of the plane. A shape that lacks one does not compile. The
// first alternative of a variant says how many dimensions it is of.

/// The smallest box around a shape, m.
template <class First, class... Rest>
[[nodiscard]] BoxN<First::dimensions> bounds(const std::variant<First, Rest...>& shape) {
  return std::visit([](const auto& s) { return bounds(s); }, shape);
}

/// What a shape fills, m^d: an area in the plane, of a polygon without self-intersections.
template <class First, class... Rest>
[[nodiscard]] double measure(const std::variant<First, Rest...>& shape) {
  return std::visit([](const auto& s) { return measure(s); }, shape);
}

/// Length of the outline, m; in the plane.
template <class First, class... Rest>
[[nodiscard]] double perimeter(const std::variant<First, Rest...>& shape) {
  return std::visit([](const auto& s) { return perimeter(s); }, shape);
}

/// Whether a point lies in a shape. A point on the surface may go either way.
template <class First, class... Rest>
[[nodiscard]] bool contains(const std::variant<First, Rest...>& shape,
                            const VecN<First::dimensions>& point) {
  return std::visit([&](const auto& s) { return contains(s, point); }, shape);
}

/// Distance from the surface, negative inside, m. Of an ellipsoid to first order in the distance
/// over its smallest radius of curvature.
template <class First, class... Rest>
[[nodiscard]] double signed_distance(const std::variant<First, Rest...>& shape,
                                     const VecN<First::dimensions>& point) {
  return std::visit([&](const auto& s) { return signed_distance(s, point); }, shape);
}

/// Largest value of direction . x over a shape.
template <class First, class... Rest>
[[nodiscard]] double farthest_along(const std::variant<First, Rest...>& shape,
                                    const VecN<First::dimensions>& direction) {
  return std::visit([&](const auto& s) { return farthest_along(s, direction); }, shape);
}

/// Where the line origin + t direction enters and leaves a shape: values of t in pairs, increasing.
/// Along an edge it goes as on one side of it.
template <class First, class... Rest>
[[nodiscard]] std::vector<double> chords(const std::variant<First, Rest...>& shape,
                                         const VecN<First::dimensions>& origin,
                                         const VecN<First::dimensions>& direction) {
  return std::visit([&](const auto& s) { return chords(s, origin, direction); }, shape);
}

/// Velocity at the start of a particle of the region at `point`, m/s. The middle is that of the
/// shape's bounds. Of the plane: what strains and turns does so in it.
[[nodiscard]] Vec velocity_at(const FluidRegion& region, const Vec& point);
/// No particle of the region is faster at the start, m/s.
[[nodiscard]] double greatest_speed(const FluidRegion& region);

}  // namespace sluice

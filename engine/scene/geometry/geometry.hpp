#pragma once

#include <concepts>
#include <variant>
#include <vector>

#include "engine/scene/geometry/plane_shapes.hpp"
#include "engine/scene/geometry/shapes.hpp"
#include "engine/scene/geometry/space_shapes.hpp"
#include "engine/scene/geometry/surfaces.hpp"
#include "engine/scene/model/scene.hpp"

namespace sluice {

// What every shape answers, of any number of dimensions: shapes.hpp has the bodies that are the
// same in all, plane_shapes.hpp those of the plane, space_shapes.hpp and surfaces.hpp those of
// space. A shape that lacks one does not compile. A point that is handed in has as many dimensions
// as the shape.

template <class T>
concept AnyShape =
    std::same_as<T, Shape> || std::same_as<T, ShapeN<2>> || std::same_as<T, ShapeN<3>>;
/// The dimension of the type of the points of a shape.
template <AnyShape S>
inline constexpr int kPointDim = std::same_as<S, ShapeN<2>>   ? 2
                                 : std::same_as<S, ShapeN<3>> ? 3
                                                              : kAnyDim;

/// The smallest box around a shape, m.
template <AnyShape S>
[[nodiscard]] BoxN<kPointDim<S>> bounds(const S& shape) {
  return std::visit([](const auto& s) -> BoxN<kPointDim<S>> { return bounds(s); }, shape);
}

/// What a shape fills, m^d: an area in the plane, of a polygon without self-intersections.
template <AnyShape S>
[[nodiscard]] double measure(const S& shape) {
  return std::visit([](const auto& s) { return measure(s); }, shape);
}

/// What surrounds a shape, m^(d-1): the length of the outline in the plane, else the surface.
template <AnyShape S>
[[nodiscard]] double perimeter(const S& shape) {
  return std::visit([](const auto& s) { return perimeter(s); }, shape);
}

/// Whether a point lies in a shape. A point on the surface may go either way.
template <AnyShape S>
[[nodiscard]] bool contains(const S& shape, const VecN<kPointDim<S>>& point) {
  return std::visit(
      [&]<class Each>(const Each& s) { return contains(s, VecN<Each::dimensions>(point)); }, shape);
}

/// Distance from the surface, negative inside, m. Of an ellipsoid to first order in the distance
/// over its smallest radius of curvature.
template <AnyShape S>
[[nodiscard]] double signed_distance(const S& shape, const VecN<kPointDim<S>>& point) {
  return std::visit(
      [&]<class Each>(const Each& s) { return signed_distance(s, VecN<Each::dimensions>(point)); },
      shape);
}

/// Largest value of direction . x over a shape.
template <AnyShape S>
[[nodiscard]] double farthest_along(const S& shape, const VecN<kPointDim<S>>& direction) {
  return std::visit(
      [&]<class Each>(const Each& s) {
        return farthest_along(s, VecN<Each::dimensions>(direction));
      },
      shape);
}

/// Where the line origin + t direction enters and leaves a shape: values of t in pairs, increasing.
/// Along an edge it goes as on one side of it.
template <AnyShape S>
[[nodiscard]] std::vector<double> chords(const S& shape, const VecN<kPointDim<S>>& origin,
                                         const VecN<kPointDim<S>>& direction) {
  return std::visit(
      [&]<class Each>(const Each& s) {
        using Point = VecN<Each::dimensions>;
        return chords(s, Point(origin), Point(direction));
      },
      shape);
}

/// Velocity at the start of a particle of the region at `point`, m/s. The middle is that of the
/// shape's bounds. What strains and turns does so in the plane of x and y.
[[nodiscard]] Vec velocity_at(const FluidRegion& region, const Vec& point);
/// No particle of the region is faster at the start, m/s.
[[nodiscard]] double greatest_speed(const FluidRegion& region);

}  // namespace sluice

#pragma once

#include <vector>

#include "engine/scene/model/scene.hpp"

namespace sluice {

/// The smallest box around a shape, m.
[[nodiscard]] Box bounds(const Shape& shape);

/// Area, m^2; of a polygon without self-intersections.
[[nodiscard]] double area(const Shape& shape);

/// Length of the outline, m; of an ellipse by Ramanujan's first formula, which is within 1e-4 to an
/// axis ratio of 5 and within 1 % beyond.
[[nodiscard]] double perimeter(const Shape& shape);

/// Whether a point lies in a shape. A point on the outline may go either way.
[[nodiscard]] bool contains(const Shape& shape, const Vec& point);

/// Distance from the outline, negative inside, m. Of an ellipse to first order in the distance
/// over its smaller radius of curvature.
[[nodiscard]] double signed_distance(const Shape& shape, const Vec& point);

/// Largest value of direction . x over a shape.
[[nodiscard]] double farthest_along(const Shape& shape, const Vec& direction);

/// Where the line origin + t direction enters and leaves a shape: values of t in pairs, increasing.
/// Along an edge it goes as on one side of it.
[[nodiscard]] std::vector<double> chords(const Shape& shape, const Vec& origin,
                                         const Vec& direction);

/// Whether no two edges of a polygon cross or overlap, O(n^2).
[[nodiscard]] bool is_simple(const Polygon& polygon);

/// Velocity at the start of a particle of the region at `point`, m/s. The middle is that of the
/// shape's bounds.
[[nodiscard]] Vec velocity_at(const FluidRegion& region, const Vec& point);
/// No particle of the region is faster at the start, m/s.
[[nodiscard]] double greatest_speed(const FluidRegion& region);

}  // namespace sluice

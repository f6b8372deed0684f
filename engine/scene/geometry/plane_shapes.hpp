#pragma once

#include <vector>

#include "engine/scene/model/shapes.hpp"

namespace sluice {

// What is of the plane alone: polygons, and shapes by their outlines. geometry.hpp says what is
// promised of the functions that it has too.

[[nodiscard]] BoxN<2> bounds(const Polygon& s);
[[nodiscard]] double measure(const Polygon& s);
[[nodiscard]] bool contains(const Polygon& s, const VecN<2>& point);
[[nodiscard]] double signed_distance(const Polygon& s, const VecN<2>& point);
[[nodiscard]] double farthest_along(const Polygon& s, const VecN<2>& direction);
[[nodiscard]] std::vector<double> chords(const Polygon& s, const VecN<2>& origin,
                                         const VecN<2>& direction);
[[nodiscard]] std::vector<double> chords(const Rectangle& s, const VecN<2>& origin,
                                         const VecN<2>& direction);

/// Length of the outline, m; of an ellipse by Ramanujan's first formula, which is within 1e-4 to an
/// axis ratio of 5 and within 1 % beyond.
[[nodiscard]] double perimeter(const Rectangle& s);
[[nodiscard]] double perimeter(const Circle& s);
[[nodiscard]] double perimeter(const Ellipse& s);
[[nodiscard]] double perimeter(const Polygon& s);

/// The corners of a rectangle as a polygon, from the lower left one, counterclockwise.
[[nodiscard]] Polygon as_polygon(const Rectangle& rectangle);

/// Twice the area inside some corners, positive where they go round counterclockwise, m^2.
[[nodiscard]] double twice_signed_area(const std::vector<VecN<2>>& corners);

/// Whether no two edges of a polygon cross or overlap, O(n^2).
[[nodiscard]] bool is_simple(const Polygon& polygon);

/// Distance of a point in the open from an ellipse, m, also where its ends are sharp: from one
/// nearest point to the next by the circle that fits the ellipse there (Chatelain's iteration).
[[nodiscard]] double distance_from_outside(const Ellipse& s, const VecN<2>& point);

}  // namespace sluice

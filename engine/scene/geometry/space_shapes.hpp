#pragma once

#include <vector>

#include "engine/scene/model/shapes.hpp"

namespace sluice {

// What is of space alone: cylinders and prisms. geometry.hpp says what is promised.

[[nodiscard]] BoxN<3> bounds(const Cylinder& s);
[[nodiscard]] BoxN<3> bounds(const Prism& s);
[[nodiscard]] double measure(const Cylinder& s);
[[nodiscard]] double measure(const Prism& s);
[[nodiscard]] double perimeter(const Cylinder& s);
[[nodiscard]] double perimeter(const Prism& s);
[[nodiscard]] bool contains(const Cylinder& s, const VecN<3>& point);
[[nodiscard]] bool contains(const Prism& s, const VecN<3>& point);
[[nodiscard]] double signed_distance(const Cylinder& s, const VecN<3>& point);
[[nodiscard]] double signed_distance(const Prism& s, const VecN<3>& point);
[[nodiscard]] double farthest_along(const Cylinder& s, const VecN<3>& direction);
[[nodiscard]] double farthest_along(const Prism& s, const VecN<3>& direction);
[[nodiscard]] std::vector<double> chords(const Cylinder& s, const VecN<3>& origin,
                                         const VecN<3>& direction);
[[nodiscard]] std::vector<double> chords(const Prism& s, const VecN<3>& origin,
                                         const VecN<3>& direction);

}  // namespace sluice

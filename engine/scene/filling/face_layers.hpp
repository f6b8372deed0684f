#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "engine/scene/model/scene.hpp"

namespace sluice {

/// Dummy particles that follow a polygon's faces in the plane, m. Layer k = 0, 1, ..., as many as a
/// wall has, is the outline moved in by (k + 1/2) dx, as far as the polygon is thick enough, with
/// particles about dx apart along it: one in each corner and a whole number on each side, so that a
/// strip of the solid holds its area.
///
/// `covered` says whether a place just outside a face is solid: such a face has no layers. Nothing
/// where the polygon is so thin that the layers of two faces would meet.
[[nodiscard]] std::optional<std::vector<Vec2>> face_layers(
    const Polygon& polygon, const Method& method, const std::function<bool(const Vec2&)>& covered);

}  // namespace sluice

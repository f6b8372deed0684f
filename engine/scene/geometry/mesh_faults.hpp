#pragma once

#include <optional>
#include <string>

#include "engine/scene/geometry/triangle_mesh.hpp"

namespace sluice {

/// What keeps triangles from bounding a body, and where, for people: an edge that has not exactly
/// two triangles, one each way. Nothing where the surface is closed; all of it may still face
/// inwards, which its volume shows.
[[nodiscard]] std::optional<std::string> mesh_fault(const Triangles& triangles);

}  // namespace sluice

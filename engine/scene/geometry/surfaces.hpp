#pragma once

#include <algorithm>
#include <concepts>
#include <limits>
#include <vector>

#include "engine/scene/geometry/triangle_mesh.hpp"
#include "engine/scene/model/shapes.hpp"

namespace sluice {

// What is bounded by triangles: heights on a grid and meshes. geometry.hpp says what is promised.

template <class S>
concept Meshed = std::same_as<S, Heights> || std::same_as<S, Mesh>;

/// The surface of a body; an empty one where it could not be made.
[[nodiscard]] const TriangleMesh& surface_of(const Heights& s);
[[nodiscard]] const TriangleMesh& surface_of(const Mesh& s);

/// Surface, sides and base; every row as long as the first, two rows and columns at least.
[[nodiscard]] Triangles triangles_of(const Heights& s);

/// Scaled, turned and moved. Sines are those of sin_of_degrees().
[[nodiscard]] Triangles placed(Triangles triangles, const Mesh& as);

/// By plain arithmetic, so that it has the same bits on every machine; exact at whole multiples of
/// 90 degrees. Within 2e-16 of the sine.
[[nodiscard]] double sin_of_degrees(double degrees);

template <Meshed S>
[[nodiscard]] BoxN<3> bounds(const S& s) {
  return surface_of(s).bounds();
}
template <Meshed S>
[[nodiscard]] double measure(const S& s) {
  return surface_of(s).volume();
}
template <Meshed S>
[[nodiscard]] double perimeter(const S& s) {
  return surface_of(s).area();
}
template <Meshed S>
[[nodiscard]] bool contains(const S& s, const VecN<3>& point) {
  return surface_of(s).contains(point);
}
template <Meshed S>
[[nodiscard]] double signed_distance(const S& s, const VecN<3>& point) {
  const double distance = surface_of(s).nearest(point).distance;
  return surface_of(s).contains(point) ? -distance : distance;
}
template <Meshed S>
[[nodiscard]] double farthest_along(const S& s, const VecN<3>& direction) {
  double farthest = -std::numeric_limits<double>::infinity();
  for (const VecN<3>& point : surface_of(s).triangles().points) {
    farthest = std::max(farthest, direction.dot(point));
  }
  return farthest;
}
template <Meshed S>
[[nodiscard]] std::vector<double> chords(const S& s, const VecN<3>& origin,
                                         const VecN<3>& direction) {
  std::vector<double> ends;
  for (const auto& each : surface_of(s).ends_of_chords(origin, direction)) ends.push_back(each.t);
  return ends;
}

}  // namespace sluice

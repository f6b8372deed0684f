#include "engine/scene/geometry/mesh_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

namespace sluice {
namespace {

/// An edge of a triangle, from its lower to its higher corner or the other way.
struct Edge {
  std::uint32_t low = 0, high = 0;
  bool upwards = false;

  [[nodiscard]] bool joins_as(const Edge& other) const {
    return low == other.low && high == other.high;
  }
  bool operator<(const Edge& other) const {
    return std::tie(low, high, upwards) < std::tie(other.low, other.high, other.upwards);
  }
};

std::vector<Edge> sorted_edges(const Triangles& triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.corners.size());
  for (const auto& corners : triangles.corners) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k], b = corners[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::string fault_text(std::size_t count, bool one_way) {
  if (count == 1) {
    return "has one triangle only: there is a hole, or triangles that do not meet corner on "
           "corner; "
           "close it";
  }
  if (count == 2 && one_way) {
    return "has two triangles that run the same way along it: one of them faces inwards; give all "
           "their corners anticlockwise as seen from outside";
  }
  return fmt::format(
      "has {} triangles, not two: bodies that touch or a triangle that is there "
      "twice; let them overlap or leave one out",
      count);
}

}  // namespace

std::optional<std::string> mesh_fault(const Triangles& triangles) {
  const std::vector<Edge> edges = sorted_edges(triangles);
  for (std::size_t first = 0, next = 0; first < edges.size(); first = next) {
    while (next < edges.size() && edges[next].joins_as(edges[first])) ++next;
    const std::size_t count = next - first;
    const bool one_way = edges[first].upwards == edges[next - 1].upwards;
    if (count == 2 && !one_way) continue;
    const Vec3& from = triangles.points[edges[first].low];
    const Vec3& to = triangles.points[edges[first].high];
    return fmt::format("is not closed: the edge from ({:.6g}) to ({:.6g}) m {}",
                       fmt::join(from, ", "), fmt::join(to, ", "), fault_text(count, one_way));
  }
  return std::nullopt;
}

}  // namespace sluice

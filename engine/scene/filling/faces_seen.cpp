#include "engine/scene/filling/faces_seen.hpp"

#include <cmath>

#include "engine/scene/filling/cells.hpp"
#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

using Point = VecN<2>;

constexpr std::string_view kSolid = "an obstacle or the gate";

bool is_whole(double cells) { return std::abs(cells - std::round(cells)) < kOffLattice; }

/// Whether a rectangle's cells, stretched to fit, are about as large as the fluid's. Each of its
/// dummy particles has a full mass, whatever the size of its cell.
bool has_full_cells(const Rectangle& solid, double dx) {
  const auto fits = [dx](double length) {
    const double cells = static_cast<double>(whole_cells(length, dx));
    return std::abs(cells * dx / length - 1.0) <= kOffArea;
  };
  return fits(solid.size.x()) && fits(solid.size.y());
}

void face_outline(const std::vector<Point>& points, const Point& point, double dx,
                  std::vector<SeenFace>& found) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& a = points[i];
    const Point edge = points[i + 1 < points.size() ? i + 1 : 0] - a;
    const double length = edge.norm();
    const double along = (point - a).dot(edge) / length;
    // One beside a corner faces none of its edges.
    if (along < 0.0 || along > length) continue;
    const Point apart = point - a - along / length * edge;
    const bool upright = std::abs(edge.x()) < 1e-9 * length;
    const bool level = std::abs(edge.y()) < 1e-9 * length;
    // A polygon's dummy particles lie on the origin's lattice.
    const bool backed = (upright && is_whole(a.x() / dx)) || (level && is_whole(a.y() / dx));
    found.push_back({apart.norm() / dx, upright || level, backed, kSolid});
  }
}

/// The faces of a solid that a point faces. A shape without a line of its own does not compile.
struct FacesSeenFrom {
  const Point& point;
  double dx;

  std::vector<SeenFace> operator()(const Rectangle& s) const {
    std::vector<SeenFace> found = outline(as_polygon(s).points);
    for (SeenFace& face : found) face.backed = has_full_cells(s, dx);
    return found;
  }
  std::vector<SeenFace> operator()(const Polygon& s) const { return outline(s.points); }
  std::vector<SeenFace> operator()(const Circle& s) const { return round(s); }
  std::vector<SeenFace> operator()(const Ellipse& s) const { return round(s); }

  [[nodiscard]] std::vector<SeenFace> outline(const std::vector<Point>& points) const {
    std::vector<SeenFace> found;
    face_outline(points, point, dx, found);
    return found;
  }
  [[nodiscard]] std::vector<SeenFace> round(const ShapeN<2>& solid) const {
    return {{std::abs(signed_distance(solid, point)) / dx, false, true, kSolid}};
  }
};

}  // namespace

std::vector<SeenFace> faces_seen(const ShapeN<2>& solid, const Point& point, double spacing) {
  return std::visit(FacesSeenFrom{point, spacing}, solid);
}

std::vector<SeenFace> faces_seen(const TankRoomN<2>& tank, const Point& point, double spacing) {
  const auto face = [&](double distance, std::string_view name) {
    return SeenFace{distance / spacing, true, true, name};
  };
  std::vector<SeenFace> faces{face(point.x(), "the tank's left wall"),
                              face(tank.size.x() - point.x(), "the tank's right wall"),
                              face(point.y(), "the tank's floor")};
  if (!tank.open_top) faces.push_back(face(tank.size.y() - point.y(), "the tank's lid"));
  return faces;
}

}  // namespace sluice

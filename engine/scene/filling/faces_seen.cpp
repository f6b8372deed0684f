#include "engine/scene/filling/faces_seen.hpp"

#include <algorithm>
#include <cmath>

#include "engine/scene/filling/cells.hpp"
#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

using Point = VecN<2>;

constexpr double kReach = 1.5;  // spacings; triangles farther than that are not looked at
constexpr std::string_view kSolid = "an obstacle or the gate";

bool is_whole(double cells) { return std::abs(cells - std::round(cells)) < kOffLattice; }

/// Whether a rectangle's cells, stretched to fit, are about as large as the fluid's. Each of its
/// dummy particles has a full mass, whatever the size of its cell.
template <int Dim>
bool has_full_cells(const Cuboid<Dim>& solid, double dx) {
  return std::all_of(solid.size.begin(), solid.size.end(), [dx](double length) {
    const double cells = static_cast<double>(whole_cells(length, dx));
    return std::abs(cells * dx / length - 1.0) <= kOffArea;
  });
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

template <int Dim>
std::vector<SeenFace> round_face(const ShapeN<Dim>& solid, const VecN<Dim>& point, double dx) {
  return {{std::abs(signed_distance(solid, point)) / dx, false, true, kSolid}};
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
  std::vector<SeenFace> operator()(const Circle& s) const { return round_face<2>(s, point, dx); }
  std::vector<SeenFace> operator()(const Ellipse& s) const { return round_face<2>(s, point, dx); }

  [[nodiscard]] std::vector<SeenFace> outline(const std::vector<Point>& points) const {
    std::vector<SeenFace> found;
    face_outline(points, point, dx, found);
    return found;
  }
};

/// The same in space.
struct FacesSeenInSpace {
  const VecN<3>& point;
  double dx;

  std::vector<SeenFace> operator()(const Cuboid<3>& s) const {
    std::vector<SeenFace> found;
    const VecN<3> from = point - s.corner;
    for (int axis = 0; axis < 3; ++axis) {
      bool beside = true;
      for (int other = 0; other < 3; ++other) {
        beside = beside && (other == axis || (from[other] >= 0.0 && from[other] <= s.size[other]));
      }
      if (!beside) continue;
      for (const double face : {0.0, s.size[axis]}) {
        found.push_back({std::abs(from[axis] - face) / dx, true, has_full_cells(s, dx), kSolid});
      }
    }
    return found;
  }
  std::vector<SeenFace> operator()(const Ball<3>& s) const { return round_face<3>(s, point, dx); }
  std::vector<SeenFace> operator()(const Ellipsoid<3>& s) const {
    return round_face<3>(s, point, dx);
  }
  std::vector<SeenFace> operator()(const Cylinder& s) const { return round_face<3>(s, point, dx); }
  std::vector<SeenFace> operator()(const Prism& s) const {
    std::vector<SeenFace> found;
    const Point in_section = point.head<2>();
    const double from = point.z() - s.z;
    if (from >= 0.0 && from <= s.depth) face_outline(s.section.points, in_section, dx, found);
    if (!contains(s.section, in_section)) return found;
    for (const double face : {s.z, s.z + s.depth}) {
      found.push_back({std::abs(point.z() - face) / dx, true, is_whole(face / dx), kSolid});
    }
    return found;
  }
  /// Triangles within reach that the point is straight beside.
  template <Meshed S>
  std::vector<SeenFace> operator()(const S& s) const {
    std::vector<SeenFace> found;
    const TriangleMesh& surface = surface_of(s);
    const double reach = kReach * dx;
    surface.for_each_in(grown(BoxN<3>{point, point}, reach), [&](std::size_t i) {
      const VecN<3> normal = surface.normal(i);
      const VecN<3> apart = nearest_point(surface.triangle(i), point) - point;
      const double distance = apart.norm();
      const bool beside = std::abs(normal.dot(apart)) >= distance * (1 - 1e-9);
      if (distance > reach || !beside || normal.isZero(0.0)) return;
      Eigen::Index axis = 0;
      const bool along_lattice = normal.cwiseAbs().maxCoeff(&axis) > 1 - 1e-9;
      const bool backed = along_lattice && is_whole((point[axis] + apart[axis]) / dx);
      found.push_back({distance / dx, along_lattice, backed, kSolid});
    });
    return found;
  }
};

}  // namespace

std::vector<SeenFace> faces_seen(const ShapeN<2>& solid, const Point& point, double spacing) {
  return std::visit(FacesSeenFrom{point, spacing}, solid);
}

std::vector<SeenFace> faces_seen(const ShapeN<3>& solid, const VecN<3>& point, double spacing) {
  return std::visit(FacesSeenInSpace{point, spacing}, solid);
}

template <int Dim>
std::vector<SeenFace> faces_seen(const TankRoomN<Dim>& tank, const VecN<Dim>& point,
                                 double spacing) {
  const auto face = [&](double distance, std::string_view name) {
    return SeenFace{distance / spacing, true, true, name};
  };
  std::vector<SeenFace> faces{face(point.x(), "the tank's left wall"),
                              face(tank.size.x() - point.x(), "the tank's right wall"),
                              face(point.y(), "the tank's floor")};
  if (!tank.open_top) faces.push_back(face(tank.size.y() - point.y(), "the tank's lid"));
  if constexpr (Dim == 3) {
    faces.push_back(face(point.z(), "the tank's wall at z = 0"));
    faces.push_back(face(tank.size.z() - point.z(), "the tank's wall at its depth"));
  }
  return faces;
}

template std::vector<SeenFace> faces_seen(const TankRoomN<2>&, const VecN<2>&, double);
template std::vector<SeenFace> faces_seen(const TankRoomN<3>&, const VecN<3>&, double);

}  // namespace sluice

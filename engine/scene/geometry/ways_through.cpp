#include "engine/scene/geometry/ways_through.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/scene/geometry/directions.hpp"
#include "engine/scene/geometry/geometry.hpp"
#include "engine/scene/geometry/outline.hpp"

namespace sluice {
namespace {

constexpr int kPerSide = 3;           // places along each side of a face
constexpr int kChordsOfBall = 24;     // through the middle of a round body
constexpr int kDiameters = 8;         // of a cylinder, round its axis
constexpr double kOffAxis = 2.0 / 3;  // of its radius
constexpr double kTouch = 1e-3;       // of a spacing: no way through a body
constexpr std::size_t kPointsOfSection = 512;
constexpr std::size_t kPointsOfSurface = 1024;  // about; each triangle of fewer has some

std::vector<Chord> chords_of(const Cuboid<3>& s, double /*dx*/) {
  std::vector<Chord> result;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int i = 0; i < kPerSide; ++i) {
      for (int j = 0; j < kPerSide; ++j) {
        Vec3 from = s.corner;
        from[u] += s.size[u] * (i + 0.5) / kPerSide;
        from[v] += s.size[v] * (j + 0.5) / kPerSide;
        Vec3 to = from;
        to[axis] += s.size[axis];
        result.emplace_back(from, to);
      }
    }
  }
  return result;
}
std::vector<Chord> chords_of(const Ellipsoid<3>& s, double /*dx*/) {
  std::vector<Chord> result;
  for (const Vec3& way : half_of_directions<3>(kChordsOfBall)) {
    const Vec3 reach = way.cwiseProduct(s.semi_axes);
    result.emplace_back(s.center - reach, s.center + reach);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 reach = s.semi_axes[axis] * Vec3::Unit(axis);
    result.emplace_back(s.center - reach, s.center + reach);
  }
  return result;
}
std::vector<Chord> chords_of(const Ball<3>& s, double dx) {
  return chords_of(Ellipsoid<3>{s.center, Vec3::Constant(s.radius)}, dx);
}
/// Along the axis in the middle and off it, and across it at several heights.
std::vector<Chord> chords_of(const Cylinder& s, double /*dx*/) {
  const Vec3 aside = s.axis.unitOrthogonal();
  const Vec3 other = s.axis.normalized().cross(aside);
  std::vector<Chord> result{{s.base, s.base + s.axis}};
  for (const Vec2& way : half_of_directions<2>(kDiameters)) {
    const Vec3 spoke = s.radius * (way.x() * aside + way.y() * other);
    for (const double side : {-kOffAxis, kOffAxis}) {
      const Vec3 off = s.base + side * spoke;
      result.emplace_back(off, off + s.axis);
    }
    for (int i = 0; i < kPerSide; ++i) {
      const Vec3 middle = s.base + (i + 0.5) / kPerSide * s.axis;
      result.emplace_back(middle - spoke, middle + spoke);
    }
  }
  return result;
}

/// From a place on the outline of a polygon straight in, until it is out again.
std::optional<double> width_at(const Polygon& s, const OutlinePoint& point, double dx) {
  for (const double width : chords(s, point.place, -point.out)) {
    if (width > kTouch * dx) return width;
  }
  return std::nullopt;
}
/// Out of a polygon at a place on its outline: up the slope of the distance.
Vec2 out_at(const Polygon& s, const Vec2& place, double dx) {
  Vec2 slope;
  for (int axis = 0; axis < 2; ++axis) {
    const Vec2 step = kTouch * dx * Vec2::Unit(axis);
    slope[axis] = signed_distance(s, place + step) - signed_distance(s, place - step);
  }
  return slope.normalized();
}
/// From the outline through the section at several z, and along z through the middle of each.
std::vector<Chord> chords_of(const Prism& s, double dx) {
  std::vector<Chord> result;
  for (const OutlinePoint& point : outline(s.section, dx / 2, kPointsOfSection)) {
    const std::optional<double> width = width_at(s.section, point, dx);
    if (!width) continue;
    const auto in_space = [](const Vec2& place, double z) { return Vec3(place.x(), place.y(), z); };
    const Vec2 to = point.place - *width * point.out;
    const Vec3 out_from = in_space(point.out, 0.0);
    const Vec3 out_to = in_space(out_at(s.section, to, dx), 0.0);
    for (int i = 0; i < kPerSide; ++i) {
      const double z = s.z + (i + 0.5) / kPerSide * s.depth;
      result.emplace_back(in_space(point.place, z), in_space(to, z), out_from, out_to);
    }
    const Vec2 middle = 0.5 * (point.place + to);
    result.emplace_back(in_space(middle, s.z), in_space(middle, s.z + s.depth));
  }
  return result;
}

/// Places that share out a triangle's area: middles of the parts when its sides are cut in `cuts`.
template <class F>
void for_each_place(const std::array<Vec3, 3>& triangle, int cuts, const F& f) {
  const auto& [a, b, c] = triangle;
  const Vec3 u = (b - a) / cuts, v = (c - a) / cuts;
  for (int i = 0; i < cuts; ++i) {
    for (int j = 0; i + j < cuts; ++j) {
      f(Vec3(a + (i + 1.0 / 3) * u + (j + 1.0 / 3) * v));
      if (i + j + 1 < cuts) f(Vec3(a + (i + 2.0 / 3) * u + (j + 2.0 / 3) * v));
    }
  }
}
/// From places on the triangles straight in, until out again.
template <Meshed S>
std::vector<Chord> chords_of(const S& s, double dx) {
  const TriangleMesh& surface = surface_of(s);
  std::vector<Chord> result;
  const std::size_t stride = 1 + surface.size() / kPointsOfSurface;
  const double share = surface.area() / kPointsOfSurface;
  for (std::size_t i = 0; i < surface.size(); i += stride) {
    const auto triangle = surface.triangle(i);
    const Vec3 out = surface.normal(i);
    if (out.isZero(0.0)) continue;
    const double area = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).norm() / 2;
    const int cuts = static_cast<int>(std::ceil(std::sqrt(std::max(1.0, area / share))));
    for_each_place(triangle, cuts, [&](const Vec3& from) {
      for (const auto& end : surface.ends_of_chords(from, -out)) {
        if (end.t <= kTouch * dx) continue;
        result.emplace_back(from, from - end.t * out, out, surface.normal(end.triangle));
        break;
      }
    });
  }
  return result;
}

}  // namespace

std::vector<Chord> ways_through(const ShapeN<3>& body, double spacing) {
  return std::visit([spacing](const auto& s) { return chords_of(s, spacing); }, body);
}

}  // namespace sluice

#include "engine/scene/geometry/plane_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sluice {
namespace {

using Point = VecN<2>;

constexpr int kIterations = 10;

double cross(const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); }

const Point& next_point(const std::vector<Point>& points, std::size_t i) {
  return points[i + 1 < points.size() ? i + 1 : 0];
}

double distance_to_segment(const Point& point, const Point& a, const Point& b) {
  const Point edge = b - a;
  const double length2 = edge.squaredNorm();
  const double t = length2 > 0 ? std::clamp((point - a).dot(edge) / length2, 0.0, 1.0) : 0.0;
  return (a + t * edge - point).norm();
}

bool on_segment(const Point& point, const Point& a, const Point& b) {
  return cross(b - a, point - a) == 0.0 && (point - a).dot(point - b) <= 0.0;
}

// Whether two closed segments have a point in common.
bool touch(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double c_side = cross(b - a, c - a), d_side = cross(b - a, d - a);
  const double a_side = cross(d - c, a - c), b_side = cross(d - c, b - c);
  const auto opposite = [](double u, double v) { return (u > 0 && v < 0) || (u < 0 && v > 0); };
  if (opposite(c_side, d_side) && opposite(a_side, b_side)) return true;
  return on_segment(a, c, d) || on_segment(b, c, d) || on_segment(c, a, b) || on_segment(d, a, b);
}

}  // namespace

BoxN<2> bounds(const Polygon& s) {
  BoxN<2> box{s.points.front(), s.points.front()};
  for (const Point& point : s.points) box.take_in(point);
  return box;
}

double twice_signed_area(const std::vector<Point>& corners) {
  double twice = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    // From the first corner: no cancellation far from the origin.
    twice += cross(corners[i] - corners[0], next_point(corners, i) - corners[0]);
  }
  return twice;
}

double measure(const Polygon& s) { return std::abs(twice_signed_area(s.points)) / 2; }

double perimeter(const Rectangle& s) { return 2 * s.size.sum(); }
double perimeter(const Circle& s) { return 2 * std::numbers::pi * s.radius; }
double perimeter(const Ellipse& s) {
  const double a = s.semi_axes.x(), b = s.semi_axes.y();
  return std::numbers::pi * (3 * (a + b) - std::sqrt((3 * a + b) * (a + 3 * b)));
}
double perimeter(const Polygon& s) {
  double sum = 0.0;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    sum += (next_point(s.points, i) - s.points[i]).norm();
  }
  return sum;
}

// Even-odd rule: counts the edges that a ray to the right crosses.
bool contains(const Polygon& s, const Point& point) {
  bool inside = false;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const Point& a = s.points[i];
    const Point& b = next_point(s.points, i);
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (point.x() < x) inside = !inside;
  }
  return inside;
}

double signed_distance(const Polygon& s, const Point& point) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    nearest = std::min(nearest, distance_to_segment(point, s.points[i], next_point(s.points, i)));
  }
  return contains(s, point) ? -nearest : nearest;
}

double farthest_along(const Polygon& s, const Point& direction) {
  double most = direction.dot(s.points.front());
  for (const Point& point : s.points) most = std::max(most, direction.dot(point));
  return most;
}

std::vector<double> chords(const Polygon& s, const Point& origin, const Point& direction) {
  std::vector<double> result;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const Point a = s.points[i] - origin;
    const Point b = next_point(s.points, i) - origin;
    const double a_side = cross(direction, a), b_side = cross(direction, b);
    if ((a_side > 0) == (b_side > 0)) continue;
    const Point meet = a + a_side / (a_side - b_side) * (b - a);
    result.push_back(direction.dot(meet) / direction.squaredNorm());
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<double> chords(const Rectangle& s, const Point& origin, const Point& direction) {
  return chords(as_polygon(s), origin, direction);
}

Polygon as_polygon(const Rectangle& rectangle) {
  const auto& [corner, size] = rectangle;
  const Point across(size.x(), 0.0);
  return {{corner, corner + across, corner + size, corner + size - across}};
}

bool is_simple(const Polygon& polygon) {
  const std::vector<Point>& points = polygon.points;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point& a = points[i];
    const Point& b = next_point(points, i);
    // The neighbouring edge shares b; it must neither be a point nor fold back onto this one.
    const Point& c = next_point(points, i + 1 < n ? i + 1 : 0);
    if (a == b || on_segment(c, a, b) || on_segment(a, b, c)) return false;
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (touch(a, b, points[j], next_point(points, j))) return false;
    }
  }
  return true;
}

double distance_from_outside(const Ellipse& s, const Point& point) {
  const Point p = (point - s.center).cwiseAbs();
  const Point& axes = s.semi_axes;
  const double excess = axes.x() * axes.x() - axes.y() * axes.y();
  Point unit = Point::Constant(std::numbers::sqrt2 / 2);
  for (int k = 0; k < kIterations; ++k) {
    const Point middle(excess * std::pow(unit.x(), 3) / axes.x(),
                       -excess * std::pow(unit.y(), 3) / axes.y());
    const double radius = (axes.cwiseProduct(unit) - middle).norm();
    const Point way = (p - middle).normalized();
    unit = (middle + radius * way).cwiseQuotient(axes).cwiseMax(0.0).cwiseMin(1.0).normalized();
  }
  return (axes.cwiseProduct(unit) - p).norm();
}

}  // namespace sluice

#include "engine/scene/geometry/outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

using Point = VecN<2>;

constexpr std::size_t kFewest = 32;  // points of a curved outline
constexpr std::size_t kFewestOnSide = 4;
constexpr double kNearCorners = 2.5;  // steps

/// Points along a side; where they are farther apart than that, two more `near` its ends.
void add_side(std::vector<OutlinePoint>& points, const Point& a, const Point& b, bool left_is_out,
              std::size_t count, double near) {
  const double length = (b - a).norm();
  const Point along = (b - a) / length;
  const Point left(-along.y(), along.x());
  const double step = length / static_cast<double>(count);
  const auto add = [&](double distance) {
    points.push_back({a + distance * along, left_is_out ? left : Point(-left)});
  };
  if (near < 0.5 * step) add(near);
  for (std::size_t k = 0; k < count; ++k) add((static_cast<double>(k) + 0.5) * step);
  if (near < 0.5 * step) add(length - near);
}

std::vector<OutlinePoint> round_outline(const Point& center, const Point& axes, std::size_t count) {
  std::vector<OutlinePoint> points;
  for (std::size_t k = 0; k < count; ++k) {
    const double angle =
        2 * std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    const Point unit(std::cos(angle), std::sin(angle));
    points.push_back({center + axes.cwiseProduct(unit), unit.cwiseQuotient(axes).normalized()});
  }
  return points;
}

std::vector<OutlinePoint> straight_outline(const std::vector<Point>& corners, double step,
                                           double near) {
  const bool clockwise = twice_signed_area(corners) < 0;
  const std::size_t n = corners.size();
  std::vector<OutlinePoint> points;
  for (std::size_t i = 0; i < n; ++i) {
    const Point& a = corners[i];
    const Point& b = corners[(i + 1) % n];
    const double wanted = std::ceil((b - a).norm() / step);
    add_side(points, a, b, clockwise, std::max(kFewestOnSide, static_cast<std::size_t>(wanted)),
             near);
  }
  return points;
}

struct OutlineOf {
  double step;
  double near;

  std::vector<OutlinePoint> operator()(const Circle& s) const {
    return (*this)(Ellipse{s.center, Point::Constant(s.radius)});
  }
  std::vector<OutlinePoint> operator()(const Ellipse& s) const {
    const auto wanted = static_cast<std::size_t>(std::ceil(perimeter(s) / step));
    return round_outline(s.center, s.semi_axes, std::max(kFewest, wanted));
  }
  std::vector<OutlinePoint> operator()(const Rectangle& s) const {
    return straight_outline({s.corner, s.corner + Point(s.size.x(), 0), s.corner + s.size,
                             s.corner + Point(0, s.size.y())},
                            step, near);
  }
  std::vector<OutlinePoint> operator()(const Polygon& s) const {
    return straight_outline(s.points, step, near);
  }
};

}  // namespace

std::vector<OutlinePoint> outline(const ShapeN<2>& shape, double step, std::size_t most) {
  const double wider = std::max(step, perimeter(shape) / static_cast<double>(most));
  return std::visit(OutlineOf{wider, kNearCorners * step}, shape);
}

}  // namespace sluice

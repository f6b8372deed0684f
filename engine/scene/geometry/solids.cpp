#include "engine/scene/geometry/solids.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

constexpr double kTiny = 1e-9;       // of the spacing: gaps and depths of rounding
constexpr std::size_t kFewest = 32;  // points of a curved outline
constexpr std::size_t kFewestOnSide = 4;
constexpr double kNearCorners = 2.5;  // steps
constexpr int kDirections = 32;
constexpr int kIterations = 10;

/// Points along a side; where they are farther apart than that, two more `near` its ends.
void add_side(std::vector<OutlinePoint>& points, const Vec& a, const Vec& b, bool left_is_out,
              std::size_t count, double near) {
  const double length = (b - a).norm();
  const Vec along = (b - a) / length;
  const Vec left(-along.y(), along.x());
  const double step = length / static_cast<double>(count);
  const auto add = [&](double distance) {
    points.push_back({a + distance * along, left_is_out ? left : Vec(-left)});
  };
  if (near < 0.5 * step) add(near);
  for (std::size_t k = 0; k < count; ++k) add((static_cast<double>(k) + 0.5) * step);
  if (near < 0.5 * step) add(length - near);
}

std::vector<OutlinePoint> round_outline(const Vec& center, const Vec& axes, std::size_t count) {
  std::vector<OutlinePoint> points;
  for (std::size_t k = 0; k < count; ++k) {
    const double angle =
        2 * std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    const Vec unit(std::cos(angle), std::sin(angle));
    points.push_back({center + axes.cwiseProduct(unit), unit.cwiseQuotient(axes).normalized()});
  }
  return points;
}

std::vector<OutlinePoint> straight_outline(const std::vector<Vec>& corners, double step,
                                           double near) {
  double twice_area = 0.0;
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec a = corners[i] - corners[0];
    const Vec b = corners[(i + 1) % n] - corners[0];
    twice_area += a.x() * b.y() - a.y() * b.x();
  }
  std::vector<OutlinePoint> points;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec& a = corners[i];
    const Vec& b = corners[(i + 1) % n];
    const double wanted = std::ceil((b - a).norm() / step);
    add_side(points, a, b, twice_area < 0,
             std::max(kFewestOnSide, static_cast<std::size_t>(wanted)), near);
  }
  return points;
}

struct OutlineOf {
  double step;
  double near;

  std::vector<OutlinePoint> operator()(const Circle& s) const {
    return (*this)(Ellipse{s.center, Vec::Constant(s.radius)});
  }
  std::vector<OutlinePoint> operator()(const Ellipse& s) const {
    const auto wanted = static_cast<std::size_t>(std::ceil(perimeter(s) / step));
    return round_outline(s.center, s.semi_axes, std::max(kFewest, wanted));
  }
  std::vector<OutlinePoint> operator()(const Rectangle& s) const {
    return straight_outline(
        {s.corner, s.corner + Vec(s.size.x(), 0), s.corner + s.size, s.corner + Vec(0, s.size.y())},
        step, near);
  }
  std::vector<OutlinePoint> operator()(const Polygon& s) const {
    return straight_outline(s.points, step, near);
  }
};

/// Distance of a point in the open from an ellipse, m, also where its ends are sharp: from one
/// nearest point to the next by the circle that fits the ellipse there (Chatelain's iteration).
double distance_to_ellipse(const Ellipse& s, const Vec& point) {
  const Vec p = (point - s.center).cwiseAbs();
  const Vec& axes = s.semi_axes;
  const double excess = axes.x() * axes.x() - axes.y() * axes.y();
  Vec unit = Vec::Constant(std::numbers::sqrt2 / 2);
  for (int k = 0; k < kIterations; ++k) {
    const Vec middle(excess * std::pow(unit.x(), 3) / axes.x(),
                     -excess * std::pow(unit.y(), 3) / axes.y());
    const double radius = (axes.cwiseProduct(unit) - middle).norm();
    const Vec way = (p - middle).normalized();
    unit = (middle + radius * way).cwiseQuotient(axes).cwiseMax(0.0).cwiseMin(1.0).normalized();
  }
  return (axes.cwiseProduct(unit) - p).norm();
}

bool is_nearer(const Shape& shape, const Vec& point, double distance) {
  const double first_order = signed_distance(shape, point);
  const auto* ellipse = std::get_if<Ellipse>(&shape);
  if (ellipse == nullptr || first_order <= 0.0) return first_order < distance;
  return distance_to_ellipse(*ellipse, point) < distance;
}

}  // namespace

Solids::Solids(const Scene& scene) : tank_(scene.tank), slack_(kTiny * scene.method.spacing) {
  for (const Shape& shape : scene.obstacles) {
    bodies_.push_back({&shape, grown(bounds(shape), slack_)});
  }
}

double Solids::depth_in_walls(const Vec& p) const {
  if (!tank_) return 0.0;
  const double aside = std::max(-p.x(), p.x() - tank_->width);
  const double over = p.y() - tank_->height;
  // Over the rim of an open tank is the air; a wall is left upwards too.
  if (tank_->open_top) {
    if (over >= 0) return 0.0;
    return std::max({0.0, -p.y(), std::min(aside, -over)});
  }
  return std::max({0.0, -p.y(), aside, over});
}

bool Solids::holds(const Vec& p) const {
  if (depth_in_walls(p) > 0.0) return true;
  return std::any_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
    return body.box.contains(p) &&
           (contains(*body.shape, p) || signed_distance(*body.shape, p) <= slack_);
  });
}

bool Solids::leaves_room(const Vec& p, double margin) const {
  const double enough = margin - slack_;
  if (tank_) {
    const double aside = std::min(p.x(), tank_->width - p.x());
    const double below = tank_->height - p.y();
    if (p.y() < enough || (!tank_->open_top && below < enough)) return false;
    // Beside a wall, or above its rim.
    if (std::hypot(std::max(0.0, aside), std::max(0.0, -below)) < enough) return false;
  }
  return std::none_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
    const Vec beyond = (body.box.min - p).cwiseMax(p - body.box.max);
    return beyond.maxCoeff() < enough && is_nearer(*body.shape, p, enough);
  });
}

double Solids::depth(const Vec& p, double most) const {
  double deepest = depth_in_walls(p);
  for (const Body& body : bodies_) {
    if (body.box.contains(p)) deepest = std::max(deepest, -signed_distance(*body.shape, p));
  }
  if (deepest >= most || !holds(p)) return deepest;
  double nearest = most;
  for (int k = 0; k < kDirections && nearest > deepest; ++k) {
    const double angle = 2 * std::numbers::pi * k / kDirections;
    const Vec way(std::cos(angle), std::sin(angle));
    nearest = reach(p, way, nearest, most / 32).value_or(nearest);
  }
  return std::max(deepest, nearest);
}

std::optional<double> Solids::reach(const Vec& from, const Vec& direction, double most,
                                    double step) const {
  const bool inside = holds(from);
  double near = 0.0;
  for (double far = step; near < most; near = far, far += step) {
    if (holds(from + far * direction) == inside) continue;
    double changed = far;
    while (changed - near > kTiny * step) {
      const double middle = 0.5 * (near + changed);
      (holds(from + middle * direction) == inside ? near : changed) = middle;
    }
    return changed < most ? std::optional(changed) : std::nullopt;
  }
  return std::nullopt;
}

std::vector<OutlinePoint> outline(const Shape& shape, double step, std::size_t most) {
  const double wider = std::max(step, perimeter(shape) / static_cast<double>(most));
  return std::visit(OutlineOf{wider, kNearCorners * step}, shape);
}

}  // namespace sluice

#include "engine/scene/geometry/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sluice {
namespace {

double cross(const Vec& a, const Vec& b) { return a.x() * b.y() - a.y() * b.x(); }

const Vec& next_point(const Polygon& polygon, std::size_t i) {
  return polygon.points[i + 1 < polygon.points.size() ? i + 1 : 0];
}

double distance_to_segment(const Vec& point, const Vec& a, const Vec& b) {
  const Vec edge = b - a;
  const double length2 = edge.squaredNorm();
  const double t = length2 > 0 ? std::clamp((point - a).dot(edge) / length2, 0.0, 1.0) : 0.0;
  return (a + t * edge - point).norm();
}

// Even-odd rule: counts the edges that a ray to the right crosses.
bool inside_polygon(const Polygon& polygon, const Vec& point) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.points.size(); ++i) {
    const Vec& a = polygon.points[i];
    const Vec& b = next_point(polygon, i);
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (point.x() < x) inside = !inside;
  }
  return inside;
}

bool on_segment(const Vec& point, const Vec& a, const Vec& b) {
  return cross(b - a, point - a) == 0.0 && (point - a).dot(point - b) <= 0.0;
}

// Whether two closed segments have a point in common.
bool touch(const Vec& a, const Vec& b, const Vec& c, const Vec& d) {
  const double c_side = cross(b - a, c - a), d_side = cross(b - a, d - a);
  const double a_side = cross(d - c, a - c), b_side = cross(d - c, b - c);
  const auto opposite = [](double u, double v) { return (u > 0 && v < 0) || (u < 0 && v > 0); };
  if (opposite(c_side, d_side) && opposite(a_side, b_side)) return true;
  return on_segment(a, c, d) || on_segment(b, c, d) || on_segment(c, a, b) || on_segment(d, a, b);
}

std::vector<double> outline_chords(const std::vector<Vec>& points, const Vec& origin,
                                   const Vec& direction) {
  std::vector<double> result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec a = points[i] - origin;
    const Vec b = points[i + 1 < points.size() ? i + 1 : 0] - origin;
    const double a_side = cross(direction, a), b_side = cross(direction, b);
    if ((a_side > 0) == (b_side > 0)) continue;
    const Vec meet = a + a_side / (a_side - b_side) * (b - a);
    result.push_back(direction.dot(meet) / direction.squaredNorm());
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<double> ellipse_chords(const Vec& center, const Vec& semi_axes, const Vec& origin,
                                   const Vec& direction) {
  // abs(from + t way) = 1 where the ellipse is the unit circle.
  const Vec from = (origin - center).cwiseQuotient(semi_axes);
  const Vec way = direction.cwiseQuotient(semi_axes);
  const double middle = -from.dot(way) / way.squaredNorm();
  const double rest = 1.0 - (from + middle * way).squaredNorm();
  if (rest <= 0.0) return {};
  const double half = std::sqrt(rest / way.squaredNorm());
  return {middle - half, middle + half};
}

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

}  // namespace

Box bounds(const Shape& shape) {
  return std::visit(Overloaded{
                        [](const Rectangle& s) {
                          return Box{s.corner, s.corner + s.size};
                        },
                        [](const Circle& s) {
                          const Vec reach = Vec::Constant(s.radius);
                          return Box{s.center - reach, s.center + reach};
                        },
                        [](const Ellipse& s) {
                          return Box{s.center - s.semi_axes, s.center + s.semi_axes};
                        },
                        [](const Polygon& s) {
                          Box box{s.points.front(), s.points.front()};
                          for (const Vec& point : s.points) {
                            box.min = box.min.cwiseMin(point);
                            box.max = box.max.cwiseMax(point);
                          }
                          return box;
                        },
                    },
                    shape);
}

double area(const Shape& shape) {
  return std::visit(Overloaded{
                        [](const Rectangle& s) { return s.size.prod(); },
                        [](const Circle& s) { return std::numbers::pi * s.radius * s.radius; },
                        [](const Ellipse& s) { return std::numbers::pi * s.semi_axes.prod(); },
                        [](const Polygon& s) {
                          double twice = 0.0;
                          for (std::size_t i = 0; i < s.points.size(); ++i) {
                            // From the first corner: no cancellation far from the origin.
                            twice +=
                                cross(s.points[i] - s.points[0], next_point(s, i) - s.points[0]);
                          }
                          return std::abs(twice) / 2;
                        },
                    },
                    shape);
}

double perimeter(const Shape& shape) {
  return std::visit(Overloaded{
                        [](const Rectangle& s) { return 2 * s.size.sum(); },
                        [](const Circle& s) { return 2 * std::numbers::pi * s.radius; },
                        [](const Ellipse& s) {
                          const double a = s.semi_axes.x(), b = s.semi_axes.y();
                          return std::numbers::pi *
                                 (3 * (a + b) - std::sqrt((3 * a + b) * (a + 3 * b)));
                        },
                        [](const Polygon& s) {
                          double sum = 0.0;
                          for (std::size_t i = 0; i < s.points.size(); ++i) {
                            sum += (next_point(s, i) - s.points[i]).norm();
                          }
                          return sum;
                        },
                    },
                    shape);
}

bool contains(const Shape& shape, const Vec& point) {
  return std::visit(Overloaded{
                        [&](const Rectangle& s) {
                          return Box{s.corner, s.corner + s.size}.contains(point);
                        },
                        [&](const Circle& s) { return (point - s.center).norm() <= s.radius; },
                        [&](const Ellipse& s) {
                          return (point - s.center).cwiseQuotient(s.semi_axes).norm() <= 1.0;
                        },
                        [&](const Polygon& s) { return inside_polygon(s, point); },
                    },
                    shape);
}

double signed_distance(const Shape& shape, const Vec& point) {
  return std::visit(Overloaded{
                        [&](const Rectangle& s) {
                          const Vec half = s.size / 2;
                          const Vec beyond = (point - s.corner - half).cwiseAbs() - half;
                          return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
                        },
                        [&](const Circle& s) { return (point - s.center).norm() - s.radius; },
                        [&](const Ellipse& s) {
                          // (q - 1) / |grad q| with q = |(x/a, y/b)|; along an axis this is exact.
                          const Vec scaled = (point - s.center).cwiseQuotient(s.semi_axes);
                          const double q = scaled.norm();
                          const double slope = scaled.cwiseQuotient(s.semi_axes).norm();
                          return slope > 0 ? (q - 1) * q / slope : -s.semi_axes.minCoeff();
                        },
                        [&](const Polygon& s) {
                          double nearest = std::numeric_limits<double>::infinity();
                          for (std::size_t i = 0; i < s.points.size(); ++i) {
                            nearest = std::min(
                                nearest, distance_to_segment(point, s.points[i], next_point(s, i)));
                          }
                          return inside_polygon(s, point) ? -nearest : nearest;
                        },
                    },
                    shape);
}

double farthest_along(const Shape& shape, const Vec& direction) {
  return std::visit(
      Overloaded{
          [&](const Rectangle& s) {
            return direction.dot(s.corner) + direction.cwiseMax(0.0).dot(s.size);
          },
          [&](const Circle& s) { return direction.dot(s.center) + s.radius * direction.norm(); },
          [&](const Ellipse& s) {
            return direction.dot(s.center) + direction.cwiseProduct(s.semi_axes).norm();
          },
          [&](const Polygon& s) {
            double most = direction.dot(s.points.front());
            for (const Vec& point : s.points) {
              most = std::max(most, direction.dot(point));
            }
            return most;
          },
      },
      shape);
}

std::vector<double> chords(const Shape& shape, const Vec& origin, const Vec& direction) {
  return std::visit(
      Overloaded{
          [&](const Rectangle& s) {
            const Vec across(s.size.x(), 0.0);
            return outline_chords(
                {s.corner, s.corner + across, s.corner + s.size, s.corner + s.size - across},
                origin, direction);
          },
          [&](const Circle& s) {
            return ellipse_chords(s.center, Vec::Constant(s.radius), origin, direction);
          },
          [&](const Ellipse& s) {
            return ellipse_chords(s.center, s.semi_axes, origin, direction);
          },
          [&](const Polygon& s) { return outline_chords(s.points, origin, direction); },
      },
      shape);
}

bool is_simple(const Polygon& polygon) {
  const std::size_t n = polygon.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec& a = polygon.points[i];
    const Vec& b = next_point(polygon, i);
    // The neighbouring edge shares b; it must neither be a point nor fold back onto this one.
    const Vec& c = next_point(polygon, i + 1 < n ? i + 1 : 0);
    if (a == b || on_segment(c, a, b) || on_segment(a, b, c)) return false;
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (touch(a, b, polygon.points[j], next_point(polygon, j))) return false;
    }
  }
  return true;
}

Vec velocity_at(const FluidRegion& region, const Vec& point) {
  if (!region.strain_rate && !region.rotation_rate) return region.velocity;
  const Box box = bounds(region.shape);
  const Vec arm = point - 0.5 * (box.min + box.max);
  const double a = region.strain_rate.value_or(0.0);
  const double w = region.rotation_rate.value_or(0.0);
  return region.velocity + Vec(a * arm.x() - w * arm.y(), w * arm.x() - a * arm.y());
}

double greatest_speed(const FluidRegion& region) {
  const double rate =
      std::abs(region.strain_rate.value_or(0.0)) + std::abs(region.rotation_rate.value_or(0.0));
  return region.velocity.norm() + rate * 0.5 * bounds(region.shape).size().norm();
}

}  // namespace sluice

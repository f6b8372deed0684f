#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>
#include <vector>

#include "engine/scene/model/shapes.hpp"
#include "engine/space/space_traits.hpp"

namespace sluice {

// Cuboids, balls and ellipsoids in any number of dimensions; geometry.hpp says what is promised.

/// Distance from a body that several parts meet in at right angles, negative inside, m, from the
/// distances from each.
template <class Distances>
[[nodiscard]] double distance_from_all(const Distances& beyond) {
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

/// Where a line origin + t direction is in one part of a body after another: t of its two ends.
struct LinePart {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();

  /// Keeps what is between two faces, `low` and `high` from the origin along their normal, m; by
  /// one step of t the line gets `rate` along it.
  void keep_between(double low, double high, double rate) {
    if (rate == 0.0) {
      if (low > 0.0 || high <= 0.0) leave = enter;
      return;
    }
    const double one = low / rate, other = high / rate;
    enter = std::max(enter, std::min(one, other));
    leave = std::min(leave, std::max(one, other));
  }
  [[nodiscard]] std::vector<double> ends() const {
    if (!(enter < leave)) return {};
    return {enter, leave};
  }
};

/// A vector whose dimension follows from the shape beside it, so that expressions convert to it.
template <int Dim>
using PointN = std::type_identity_t<VecN<Dim>>;

template <int Dim>
[[nodiscard]] BoxN<Dim> bounds(const Cuboid<Dim>& s) {
  return {s.corner, s.corner + s.size};
}
template <int Dim>
[[nodiscard]] BoxN<Dim> bounds(const Ball<Dim>& s) {
  const VecN<Dim> reach = VecN<Dim>::Constant(s.radius);
  return {s.center - reach, s.center + reach};
}
template <int Dim>
[[nodiscard]] BoxN<Dim> bounds(const Ellipsoid<Dim>& s) {
  return {s.center - s.semi_axes, s.center + s.semi_axes};
}

template <int Dim>
[[nodiscard]] double measure(const Cuboid<Dim>& s) {
  return s.size.prod();
}
template <int Dim>
[[nodiscard]] double measure(const Ball<Dim>& s) {
  return times_power<Dim>(SpaceTraits<Dim>::unit_ball, s.radius);
}
template <int Dim>
[[nodiscard]] double measure(const Ellipsoid<Dim>& s) {
  return SpaceTraits<Dim>::unit_ball * s.semi_axes.prod();
}

// Surfaces of bodies of space, m^2; plane_shapes.hpp has the outlines of the plane.
[[nodiscard]] inline double perimeter(const Cuboid<3>& s) {
  return 2.0 * (s.size[0] * s.size[1] + s.size[1] * s.size[2] + s.size[2] * s.size[0]);
}
[[nodiscard]] inline double perimeter(const Ball<3>& s) {
  return 4.0 * std::numbers::pi * s.radius * s.radius;
}
/// By Thomsen's formula, which is within 1.1 %.
[[nodiscard]] inline double perimeter(const Ellipsoid<3>& s) {
  constexpr double kPower = 1.6075;
  const auto pair = [&](int one, int other) {
    return std::pow(s.semi_axes[one] * s.semi_axes[other], kPower);
  };
  const double mean = (pair(0, 1) + pair(1, 2) + pair(2, 0)) / 3.0;
  return 4.0 * std::numbers::pi * std::pow(mean, 1.0 / kPower);
}

template <int Dim>
[[nodiscard]] bool contains(const Cuboid<Dim>& s, const PointN<Dim>& point) {
  return bounds(s).contains(point);
}
template <int Dim>
[[nodiscard]] bool contains(const Ball<Dim>& s, const PointN<Dim>& point) {
  return (point - s.center).norm() <= s.radius;
}
template <int Dim>
[[nodiscard]] bool contains(const Ellipsoid<Dim>& s, const PointN<Dim>& point) {
  return (point - s.center).cwiseQuotient(s.semi_axes).norm() <= 1.0;
}

template <int Dim>
[[nodiscard]] double signed_distance(const Cuboid<Dim>& s, const PointN<Dim>& point) {
  const VecN<Dim> half = s.size / 2;
  const VecN<Dim> beyond = (point - s.corner - half).cwiseAbs() - half;
  return distance_from_all(beyond);
}
template <int Dim>
[[nodiscard]] double signed_distance(const Ball<Dim>& s, const PointN<Dim>& point) {
  return (point - s.center).norm() - s.radius;
}
/// (q - 1) / |grad q| with q = |(x/a, y/b, ...)|; along an axis this is exact.
template <int Dim>
[[nodiscard]] double signed_distance(const Ellipsoid<Dim>& s, const PointN<Dim>& point) {
  const VecN<Dim> scaled = (point - s.center).cwiseQuotient(s.semi_axes);
  const double q = scaled.norm();
  const double slope = scaled.cwiseQuotient(s.semi_axes).norm();
  return slope > 0 ? (q - 1) * q / slope : -s.semi_axes.minCoeff();
}

template <int Dim>
[[nodiscard]] double farthest_along(const Cuboid<Dim>& s, const PointN<Dim>& direction) {
  return direction.dot(s.corner) + direction.cwiseMax(0.0).dot(s.size);
}
template <int Dim>
[[nodiscard]] double farthest_along(const Ball<Dim>& s, const PointN<Dim>& direction) {
  return direction.dot(s.center) + s.radius * direction.norm();
}
template <int Dim>
[[nodiscard]] double farthest_along(const Ellipsoid<Dim>& s, const PointN<Dim>& direction) {
  return direction.dot(s.center) + direction.cwiseProduct(s.semi_axes).norm();
}

template <int Dim>
[[nodiscard]] std::vector<double> chords(const Ellipsoid<Dim>& s, const PointN<Dim>& origin,
                                         const PointN<Dim>& direction) {
  // abs(from + t way) = 1 where the ellipsoid is the unit ball.
  const VecN<Dim> from = (origin - s.center).cwiseQuotient(s.semi_axes);
  const VecN<Dim> way = direction.cwiseQuotient(s.semi_axes);
  const double middle = -from.dot(way) / way.squaredNorm();
  const double rest = 1.0 - (from + middle * way).squaredNorm();
  if (rest <= 0.0) return {};
  const double half = std::sqrt(rest / way.squaredNorm());
  return {middle - half, middle + half};
}
template <int Dim>
[[nodiscard]] std::vector<double> chords(const Ball<Dim>& s, const PointN<Dim>& origin,
                                         const PointN<Dim>& direction) {
  return chords(Ellipsoid<Dim>{s.center, VecN<Dim>::Constant(s.radius)}, origin, direction);
}

/// Of a rectangle plane_shapes.hpp has others, by its outline: results depend on their last bits.
template <int Dim>
[[nodiscard]] std::vector<double> chords(const Cuboid<Dim>& s, const PointN<Dim>& origin,
                                         const PointN<Dim>& direction) {
  LinePart part;
  for (int axis = 0; axis < Dim; ++axis) {
    part.keep_between(s.corner[axis] - origin[axis], s.corner[axis] + s.size[axis] - origin[axis],
                      direction[axis]);
  }
  return part.ends();
}

}  // namespace sluice

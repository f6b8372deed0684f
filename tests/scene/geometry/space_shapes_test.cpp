// Cylinders and prisms, against plain samples of their surfaces.

#include "engine/scene/geometry/space_shapes.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

Cylinder upright() { return {Vec3(1, 1, 1), Vec3(0, 2, 0), 0.75}; }
Cylinder aslant() { return {Vec3(0.5, 2, 0.25), Vec3(1.5, -1, 0.75), 0.5}; }
Polygon triangle() { return {{Vec2(0, 0), Vec2(2, 0.5), Vec2(0.5, 1.5)}}; }
/// An L of area 3: the square of side 2 without its upper right quarter.
Polygon ell() { return {{Vec2(0, 0), Vec2(2, 0), Vec2(2, 1), Vec2(1, 1), Vec2(1, 2), Vec2(0, 2)}}; }
Prism sill() { return {triangle(), 0.5, 1.0}; }
Prism column() { return {ell(), -0.5, 1.5}; }

std::vector<ShapeN<3>> shapes() { return {upright(), aslant(), sill(), column()}; }

/// Points on a surface; each place on it has one within kWithin.
constexpr double kWithin = 0.06;
constexpr double kNet = 0.05;  // of a net of squares

int steps(double length) { return static_cast<int>(std::ceil(length / kNet)); }

std::vector<Vec3> surface(const Cylinder& s) {
  const Vec3 aside = s.axis.unitOrthogonal();
  const Vec3 other = s.axis.normalized().cross(aside);
  const int around = steps(2 * std::numbers::pi * s.radius), high = steps(s.axis.norm()),
            out = steps(s.radius);
  std::vector<Vec3> points;
  for (int k = 0; k < around; ++k) {
    const double angle = 2 * std::numbers::pi * k / around;
    const Vec3 spoke = s.radius * (std::cos(angle) * aside + std::sin(angle) * other);
    for (int i = 0; i <= high; ++i) points.emplace_back(s.base + spoke + s.axis * i / high);
    for (int i = 0; i <= out; ++i) {
      points.emplace_back(s.base + spoke * i / out);
      points.emplace_back(s.base + s.axis + spoke * i / out);
    }
  }
  return points;
}

std::vector<Vec3> surface(const Prism& s) {
  std::vector<Vec3> points;
  const int deep = steps(s.depth);
  const std::vector<Vec2>& corners = s.section.points;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec2 a = corners[k], b = corners[(k + 1) % corners.size()];
    const int along = steps((b - a).norm());
    for (int i = 0; i < along; ++i) {
      const Vec2 place = a + (b - a) * i / along;
      for (int j = 0; j <= deep; ++j) {
        points.emplace_back(place.x(), place.y(), s.z + s.depth * j / deep);
      }
    }
  }
  const Box2 box = bounds(s.section);
  for (double x = box.min.x(); x <= box.max.x(); x += kNet) {
    for (double y = box.min.y(); y <= box.max.y(); y += kNet) {
      if (!contains(s.section, Vec2(x, y))) continue;
      points.emplace_back(x, y, s.z);
      points.emplace_back(x, y, s.z + s.depth);
    }
  }
  return points;
}

std::vector<Vec3> surface(const ShapeN<3>& shape) {
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) return surface(*cylinder);
  return surface(std::get<Prism>(shape));
}

/// Somewhere in a box of 6 m about the shapes.
Vec3 somewhere(std::mt19937& dice) {
  std::uniform_real_distribution<double> one(-2.0, 4.0);
  return {one(dice), one(dice), one(dice)};
}

TEST(SpaceShapes, MeasuresAreThoseOfTheTextbook) {
  EXPECT_DOUBLE_EQ(measure(upright()), std::numbers::pi * 0.5625 * 2);
  EXPECT_DOUBLE_EQ(perimeter(upright()),
                   2 * std::numbers::pi * 0.5625 + 2 * std::numbers::pi * 0.75 * 2);
  EXPECT_DOUBLE_EQ(measure(column()), 4.5);
  EXPECT_DOUBLE_EQ(perimeter(column()), 2 * 3 + 8 * 1.5);
  Prism clockwise = column();
  std::reverse(clockwise.section.points.begin(), clockwise.section.points.end());
  EXPECT_DOUBLE_EQ(measure(clockwise), 4.5);
}

TEST(SpaceShapes, HoldAsManyPointsOfALatticeAsTheirMeasureHasCells) {
  for (const ShapeN<3>& shape : shapes()) {
    const double step = 0.02;
    const BoxN<3> box = bounds(shape);
    double count = 0.0;
    for (double z = box.min.z() + 0.5 * step; z < box.max.z(); z += step) {
      for (double y = box.min.y() + 0.5 * step; y < box.max.y(); y += step) {
        for (double x = box.min.x() + 0.5 * step; x < box.max.x(); x += step) {
          if (contains(shape, Vec3(x, y, z))) count += 1.0;
        }
      }
    }
    EXPECT_NEAR(count * std::pow(step, 3) / measure(shape), 1.0, 0.005) << shape.index();
  }
}

TEST(SpaceShapes, DistancesAreExactWhereTheyAreKnown) {
  const Cylinder pillar = upright();
  EXPECT_DOUBLE_EQ(signed_distance(pillar, Vec3(1, 2, 1)), -0.75) << "the side is nearest";
  EXPECT_DOUBLE_EQ(signed_distance(pillar, Vec3(1, 2.75, 1)), -0.25) << "the top";
  EXPECT_DOUBLE_EQ(signed_distance(pillar, Vec3(1, 2, 3)), 1.25);
  EXPECT_DOUBLE_EQ(signed_distance(pillar, Vec3(1, 0, 1.5)), 1.0);
  EXPECT_DOUBLE_EQ(signed_distance(pillar, Vec3(1 + 0.75 + 3, 3 + 4, 1)), 5.0) << "the rim";
  EXPECT_DOUBLE_EQ(signed_distance(column(), Vec3(0.5, 0.5, 0.25)), -0.5);
  EXPECT_DOUBLE_EQ(signed_distance(column(), Vec3(0.5, 0.5, 0.75)), -0.25) << "the end";
  EXPECT_DOUBLE_EQ(signed_distance(column(), Vec3(1.5, 1.25, 0.5)), 0.25) << "in the notch";
  EXPECT_DOUBLE_EQ(signed_distance(column(), Vec3(-3, 0.5, 5)), 5.0) << "an edge";
}

TEST(SpaceShapes, DistancesAreThoseOfTheNearestPointOfTheSurface) {
  std::mt19937 dice(1);
  for (const ShapeN<3>& shape : shapes()) {
    const std::vector<Vec3> points = surface(shape);
    for (const Vec3& each : points) ASSERT_NEAR(signed_distance(shape, each), 0.0, 1e-12);
    for (int k = 0; k < 200; ++k) {
      const Vec3 place = somewhere(dice);
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vec3& each : points) nearest = std::min(nearest, (each - place).norm());
      const double distance = std::abs(signed_distance(shape, place));
      ASSERT_LE(distance, nearest + 1e-12) << shape.index() << " at " << place.transpose();
      ASSERT_GE(distance, nearest - kWithin) << shape.index() << " at " << place.transpose();
    }
  }
}

RC_GTEST_PROP(SpaceShapes, DistanceChangesByNoMoreThanThePlace, (unsigned seed)) {
  std::mt19937 dice(seed);
  const Vec3 one = somewhere(dice), other = somewhere(dice);
  for (const ShapeN<3>& shape : shapes()) {
    const double change = signed_distance(shape, one) - signed_distance(shape, other);
    RC_ASSERT(std::abs(change) <= (one - other).norm() + 1e-12);
  }
}

RC_GTEST_PROP(SpaceShapes, DistanceIsNegativeExactlyInside, (unsigned seed)) {
  std::mt19937 dice(seed);
  const Vec3 place = somewhere(dice);
  for (const ShapeN<3>& shape : shapes()) {
    const double distance = signed_distance(shape, place);
    if (std::abs(distance) < 1e-9) continue;
    RC_ASSERT(contains(shape, place) == (distance < 0.0));
    if (distance < 0.0) RC_ASSERT(bounds(shape).contains(place));
  }
}

TEST(SpaceShapes, ReachAsFarAsTheirSurfaceInEveryDirection) {
  std::mt19937 dice(2);
  for (const ShapeN<3>& shape : shapes()) {
    const std::vector<Vec3> points = surface(shape);
    for (int k = 0; k < 100; ++k) {
      const Vec3 direction = (somewhere(dice) - Vec3::Ones()).normalized();
      double most = -std::numeric_limits<double>::infinity();
      for (const Vec3& each : points) most = std::max(most, direction.dot(each));
      ASSERT_GE(farthest_along(shape, direction), most - 1e-12) << shape.index();
      ASSERT_LE(farthest_along(shape, direction), most + kWithin) << shape.index();
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double low = -farthest_along(shape, -Vec3::Unit(axis));
      EXPECT_DOUBLE_EQ(bounds(shape).min[axis], low) << shape.index();
      EXPECT_DOUBLE_EQ(bounds(shape).max[axis], farthest_along(shape, Vec3::Unit(axis)));
    }
  }
}

RC_GTEST_PROP(SpaceShapes, ChordsBeginAndEndOnTheSurface, (unsigned seed)) {
  std::mt19937 dice(seed);
  const Vec3 origin = somewhere(dice);
  for (const ShapeN<3>& shape : shapes()) {
    for (const Vec3& direction :
         {Vec3(somewhere(dice) - origin), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
      const std::vector<double> ends = chords(shape, origin, direction);
      RC_ASSERT(ends.size() % 2 == 0);
      const auto distance = [&](double t) {
        return signed_distance(shape, origin + t * direction);
      };
      for (std::size_t i = 0; i < ends.size(); ++i) {
        RC_ASSERT(std::abs(distance(ends[i])) < 1e-9);
        if (i == 0) continue;
        const double between = distance((ends[i - 1] + ends[i]) / 2);
        RC_ASSERT((i % 2 == 1 ? between : -between) < 1e-9);
      }
      for (double t = -5.0; t < 5.0; t += 0.25) {
        const auto after = std::upper_bound(ends.begin(), ends.end(), t) - ends.begin();
        if (std::abs(distance(t)) > 1e-9) RC_ASSERT((after % 2 == 1) == (distance(t) < 0.0));
      }
    }
  }
}

TEST(SpaceShapes, AreTheSameTurnedByAQuarter) {
  // Round z by a quarter: x to y, y to -x.
  const auto turned = [](const Vec3& v) { return Vec3(-v.y(), v.x(), v.z()); };
  const Cylinder rod{turned(aslant().base), turned(aslant().axis), aslant().radius};
  Prism wedge = sill();
  for (Vec2& each : wedge.section.points) each = Vec2(-each.y(), each.x());
  EXPECT_DOUBLE_EQ(measure(rod), measure(aslant()));
  EXPECT_DOUBLE_EQ(measure(wedge), measure(sill()));
  std::mt19937 dice(3);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 place = somewhere(dice);
    ASSERT_NEAR(signed_distance(rod, turned(place)), signed_distance(aslant(), place), 1e-12);
    ASSERT_NEAR(signed_distance(wedge, turned(place)), signed_distance(sill(), place), 1e-12);
  }
  // A cylinder from its other end is the same one.
  const Cylinder back{aslant().base + aslant().axis, -aslant().axis, aslant().radius};
  EXPECT_NEAR(signed_distance(back, Vec3(0, 0, 0)), signed_distance(aslant(), Vec3(0, 0, 0)),
              1e-12);
}

}  // namespace
}  // namespace sluice

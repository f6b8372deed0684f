#include "engine/scene/geometry/geometry.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

namespace sluice {
namespace {

constexpr double kPi = std::numbers::pi;

Polygon square() { return {{Vec2(0, 0), Vec2(2, 0), Vec2(2, 2), Vec2(0, 2)}}; }
/// An L of area 3: the square of side 2 without its upper right quarter.
Polygon corner() {
  return {{Vec2(0, 0), Vec2(2, 0), Vec2(2, 1), Vec2(1, 1), Vec2(1, 2), Vec2(0, 2)}};
}

TEST(Geometry, AreasAreThoseOfTheTextbook) {
  EXPECT_DOUBLE_EQ(measure(Rectangle{Vec2(1, 1), Vec2(2, 3)}), 6);
  EXPECT_DOUBLE_EQ(measure(Circle{Vec2(5, 5), 2}), 4 * kPi);
  EXPECT_DOUBLE_EQ(measure(Ellipse{Vec2(5, 5), Vec2(2, 3)}), 6 * kPi);
  EXPECT_DOUBLE_EQ(measure(corner()), 3);
}

TEST(Geometry, OutlinesAreThoseOfTheTextbook) {
  EXPECT_DOUBLE_EQ(perimeter(Rectangle{Vec2(1, 1), Vec2(2, 3)}), 10);
  EXPECT_DOUBLE_EQ(perimeter(Circle{Vec2(5, 5), 2}), 4 * kPi);
  EXPECT_DOUBLE_EQ(perimeter(Ellipse{Vec2(5, 5), Vec2(2, 2)}), 4 * kPi);
  // 4 a E(m) with m = 1 - 1/4: E(3/4) = 1.2110560275684594 (Abramowitz and Stegun, table 17.1).
  EXPECT_NEAR(perimeter(Ellipse{Vec2(0, 0), Vec2(2, 1)}), 8 * 1.2110560275684594, 1e-3);
  EXPECT_DOUBLE_EQ(perimeter(corner()), 8);
}

TEST(Geometry, DistancesAreExactWhereTheyAreKnown) {
  const Shape rectangle = Rectangle{Vec2(0, 0), Vec2(4, 2)};
  EXPECT_DOUBLE_EQ(signed_distance(rectangle, Vec2(2, 1)), -1);
  EXPECT_DOUBLE_EQ(signed_distance(rectangle, Vec2(7, 6)), 5);
  EXPECT_DOUBLE_EQ(signed_distance(rectangle, Vec2(2, 2.5)), 0.5);
  EXPECT_DOUBLE_EQ(signed_distance(Circle{Vec2(1, 0), 2}, Vec2(1, 5)), 3);
  EXPECT_DOUBLE_EQ(signed_distance(Ellipse{Vec2(0, 0), Vec2(2, 1)}, Vec2(2.5, 0)), 0.5);
  EXPECT_DOUBLE_EQ(signed_distance(Ellipse{Vec2(0, 0), Vec2(2, 1)}, Vec2(0, 0.75)), -0.25);
  EXPECT_LT(signed_distance(Ellipse{Vec2(0, 0), Vec2(2, 1)}, Vec2(0, 0)), 0);
  EXPECT_DOUBLE_EQ(signed_distance(corner(), Vec2(1.5, 1.5)), 0.5);
  EXPECT_DOUBLE_EQ(signed_distance(corner(), Vec2(0.5, 0.5)), -0.5);
}

TEST(Geometry, FarthestPointOfAnEllipseIsWhereItsTangentStandsAcross) {
  // Along (3, 4)/5: sqrt((a 3/5)^2 + (b 4/5)^2).
  const Vec2 direction(0.6, 0.8);
  EXPECT_DOUBLE_EQ(farthest_along(Ellipse{Vec2(1, 1), Vec2(2, 1)}, direction),
                   1.4 + std::hypot(1.2, 0.8));
  EXPECT_DOUBLE_EQ(farthest_along(Circle{Vec2(1, 1), 3}, direction), 4.4);
  EXPECT_DOUBLE_EQ(farthest_along(Rectangle{Vec2(1, 1), Vec2(1, 1)}, -direction), -1.4);
  EXPECT_DOUBLE_EQ(farthest_along(corner(), direction), 2.2);
}

TEST(Geometry, TellsSimplePolygonsFromOthers) {
  EXPECT_TRUE(is_simple(square()));
  EXPECT_TRUE(is_simple(corner()));
  EXPECT_FALSE(is_simple({{Vec2(0, 0), Vec2(1, 1), Vec2(1, 0), Vec2(0, 1)}})) << "crosses";
  EXPECT_FALSE(is_simple({{Vec2(0, 0), Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)}})) << "repeats a corner";
  EXPECT_FALSE(is_simple({{Vec2(0, 0), Vec2(1, 0), Vec2(2, 0)}})) << "has no area";
  EXPECT_FALSE(is_simple({{Vec2(0, 0), Vec2(2, 0), Vec2(1, 0), Vec2(1, 1)}})) << "folds back";
  EXPECT_FALSE(is_simple({{Vec2(0, 0), Vec2(2, 0), Vec2(2, 1), Vec2(1, 0), Vec2(0, 1)}}))
      << "touches";
}

RC_GTEST_PROP(Geometry, DistanceIsNegativeExactlyInside, (int x, int y)) {
  const Vec2 point(std::remainder(x / 7.0, 6.0), std::remainder(y / 11.0, 6.0));
  for (const Shape& shape :
       {Shape(Rectangle{Vec2(-1, -2), Vec2(3, 3)}), Shape(Circle{Vec2(0.5, 0), 2}),
        Shape(Ellipse{Vec2(0, 0), Vec2(2, 1)}), Shape(corner())}) {
    const double distance = signed_distance(shape, point);
    if (std::abs(distance) < 1e-9) continue;
    RC_ASSERT(contains(shape, point) == (distance < 0));
    if (distance < 0) RC_ASSERT(bounds(shape).contains(point));
  }
}

TEST(Chords, AreWhereALineEntersAndLeaves) {
  const Vec2 up(0, 1);
  EXPECT_EQ(chords(Rectangle{Vec2(1, 2), Vec2(3, 4)}, Vec2(2, 0), up), (std::vector<double>{2, 6}));
  EXPECT_TRUE(chords(Rectangle{Vec2(1, 2), Vec2(3, 4)}, Vec2(5, 0), up).empty());
  const std::vector<double> circle = chords(Circle{Vec2(1, 1), 5}, Vec2(4, 0), up);
  ASSERT_EQ(circle.size(), 2U);
  EXPECT_DOUBLE_EQ(circle[0], -3);
  EXPECT_DOUBLE_EQ(circle[1], 5);
  const std::vector<double> ellipse =
      chords(Ellipse{Vec2(0, 0), Vec2(2, 1)}, Vec2(-9, 0), Vec2(3, 0));
  ASSERT_EQ(ellipse.size(), 2U);
  EXPECT_DOUBLE_EQ(ellipse[0], 7.0 / 3);
  EXPECT_DOUBLE_EQ(ellipse[1], 11.0 / 3);
  // A U: up the middle only its floor, along a level both arms.
  const Polygon u{{Vec2(0, 0), Vec2(3, 0), Vec2(3, 3), Vec2(2, 3), Vec2(2, 1), Vec2(1, 1),
                   Vec2(1, 3), Vec2(0, 3)}};
  EXPECT_EQ(chords(u, Vec2(1.5, 0), up), (std::vector<double>{0, 1}));
  EXPECT_EQ(chords(u, Vec2(0, 2), Vec2(1, 0)), (std::vector<double>{0, 1, 2, 3}));
}

}  // namespace
}  // namespace sluice

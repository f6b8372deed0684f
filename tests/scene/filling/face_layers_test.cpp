#include "engine/scene/filling/face_layers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/scene/filling/walls.hpp"
#include "engine/scene/geometry/geometry.hpp"
#include "tests/scene/support.hpp"

namespace sluice {
namespace {

constexpr double kDx = 0.01;

Method coarse() {
  Method method;
  method.spacing = kDx;
  method.smoothing_length = kDx;
  return method;
}

bool nothing_covered(const Vec2&) { return false; }

Polygon box(double x, double y, double width, double height) {
  return {{Vec2(x, y), Vec2(x + width, y), Vec2(x + width, y + height), Vec2(x, y + height)}};
}

Polygon turned(const Polygon& polygon, double angle) {
  Polygon result;
  for (const Vec2& p : polygon.points) {
    result.points.emplace_back(std::cos(angle) * p.x() - std::sin(angle) * p.y(),
                               std::sin(angle) * p.x() + std::cos(angle) * p.y());
  }
  return result;
}

TEST(FaceLayers, OfABoxOfWholeSpacingsAreALatticeWhereverItStands) {
  // 20 x 12 cells less the 14 x 6 that are deeper than three layers.
  for (const double angle : {0.0, 0.3}) {
    const Polygon solid = turned(box(0.0037, 0.0042, 0.2, 0.12), angle);
    const std::vector<Vec2> points = *face_layers(solid, coarse(), nothing_covered);
    EXPECT_EQ(points.size(), 20U * 12U - 14U * 6U);
    EXPECT_NEAR(testing::smallest_distance(points), kDx, 1e-9);
    for (const Vec2& point : points) {
      const double layer = -signed_distance(solid, point) / kDx - 0.5;
      EXPECT_NEAR(layer, std::round(layer), 1e-9);
    }
  }
}

TEST(FaceLayers, DoNotDependOnTheOrderOfTheCorners) {
  Polygon back = box(0, 0, 0.2, 0.12);
  std::reverse(back.points.begin(), back.points.end());
  EXPECT_EQ(face_layers(back, coarse(), nothing_covered)->size(), 156U);
}

TEST(FaceLayers, LieBehindOpenFacesAlone) {
  // A bed of 5.5 spacings on the floor between the walls: three rows under its upper face.
  const auto covered = [](const Vec2& p) { return p.x() < 0 || p.x() > 0.6 || p.y() < 0; };
  const auto points = *face_layers(box(0, 0, 0.6, 0.055), coarse(), covered);
  ASSERT_EQ(points.size(), 180U);
  double left = 1.0;
  for (const Vec2& point : points) {
    const double layer = (0.055 - point.y()) / kDx - 0.5;
    EXPECT_NEAR(layer, std::round(layer), 1e-9);
    left = std::min(left, point.x());
  }
  EXPECT_NEAR(left, kDx / 2, 1e-9);
  EXPECT_NEAR(testing::smallest_distance(points), kDx, 1e-9);
}

TEST(FaceLayers, GoStraightIntoTheCornerOfAnL) {
  // The cells within three of the two faces that meet at (0, 0), from 20 spacings of each: 20 of
  // each layer on either side and the k-th corner's 2 k + 1.
  const Polygon solid{
      {Vec2(-0.1, -0.1), Vec2(0.2, -0.1), Vec2(0.2, 0), Vec2(0, 0), Vec2(0, 0.2), Vec2(-0.1, 0.2)}};
  const auto covered = [](const Vec2& p) {
    return p.x() < -0.1 || p.y() < -0.1 || p.x() > 0.2 || p.y() > 0.2;
  };
  const auto points = *face_layers(solid, coarse(), covered);
  EXPECT_EQ(points.size(), 2U * 3U * 20U + 9U);
  EXPECT_NEAR(testing::smallest_distance(points), kDx, 1e-9);
}

TEST(FaceLayers, HoldTheAreaOfAStripAlongARoundFace) {
  // A polygon of 90 sides, as good as a circle: three spacings deep, pi (R^2 - (R - 3 dx)^2).
  Polygon round;
  for (int k = 0; k < 90; ++k) {
    const double angle = 2 * std::numbers::pi * k / 90;
    round.points.emplace_back(0.1 * std::cos(angle), 0.1 * std::sin(angle));
  }
  const auto points = *face_layers(round, coarse(), nothing_covered);
  const double strip = std::numbers::pi * (0.01 - 0.0049) / (kDx * kDx);
  EXPECT_NEAR(static_cast<double>(points.size()), strip, 0.01 * strip);
  EXPECT_GT(testing::smallest_distance(points), 0.74 * kDx);
}

TEST(FaceLayers, LieInsideAndApartAtAnyCorners) {
  // Stars with 3 to 14 tips that are 0.1 and 0.06 m from the middle, and the same without notches.
  for (int tips = 3; tips < 15; ++tips) {
    for (const double notch : {0.06, 0.1}) {
      Polygon star;
      for (int k = 0; k < 2 * tips; ++k) {
        const double angle = std::numbers::pi * k / tips + 0.1;
        const double radius = k % 2 == 0 ? 0.1 : notch;
        star.points.emplace_back(5 + radius * std::cos(angle), radius * std::sin(angle));
      }
      const auto points = face_layers(star, coarse(), [](const Vec2& p) { return p.y() < 0; });
      EXPECT_TRUE(points || notch < 0.1) << tips;
      if (!points) continue;
      EXPECT_GT(testing::smallest_distance(*points), 0.74 * kDx) << tips;
      for (const Vec2& point : *points) EXPECT_LT(signed_distance(star, point), 0.0) << tips;
    }
  }
}

TEST(FaceLayers, AreOnlyMadeWhereThoseOfTwoFacesStayApart) {
  EXPECT_TRUE(face_layers(turned(box(0, 0, 0.2, 0.05), 0.4), coarse(), nothing_covered));
  EXPECT_FALSE(face_layers(turned(box(0, 0, 0.2, 0.049), 0.4), coarse(), nothing_covered));
  const Polygon wedge{{Vec2(0, 0), Vec2(0.4, 0), Vec2(0.4, 0.1)}};
  EXPECT_FALSE(face_layers(wedge, coarse(), nothing_covered));
  const auto floor = [](const Vec2& p) { return p.y() < 0 || p.x() > 0.4; };
  EXPECT_TRUE(face_layers(wedge, coarse(), floor)) << "the floor goes on below it";
}

}  // namespace
}  // namespace sluice

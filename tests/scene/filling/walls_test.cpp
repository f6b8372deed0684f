#include "engine/scene/filling/walls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/scene/support.hpp"

namespace sluice {
namespace {

Method method(double spacing, double smoothing_ratio = 1.0) {
  Method m;
  m.spacing = spacing;
  m.smoothing_length = smoothing_ratio * spacing;
  return m;
}

TEST(TankWalls, AreThreeLayersOfThePapersTank) {
  // 1.61/0.003 = 536.7 -> 537 columns, 200 rows: 3 (537 + 6) + 2 x 3 x 200.
  const Tank tank{1.61, 0.6, {}, true};
  EXPECT_EQ(tank_walls(tank, method(0.003)).size(), 2829U);
  EXPECT_EQ(count_tank_walls(tank, method(0.003)), 2829.0);
}

TEST(TankWalls, AreCountedAsTheyAreMade) {
  for (const bool open : {true, false}) {
    for (const double ratio : {0.8, 1.0, 1.3, 2.5}) {
      const Tank tank{1.03, 0.47, {}, open};
      EXPECT_EQ(static_cast<double>(tank_walls(tank, method(0.05, ratio)).size()),
                count_tank_walls(tank, method(0.05, ratio)));
    }
  }
}

TEST(TankWalls, LieOutsideAndNowhereTwice) {
  for (const bool open : {true, false}) {
    const std::vector<Vec> walls = tank_walls({1.03, 0.47, {}, open}, method(0.05));
    // Stretched along a wall by half a cell in nine at the most.
    EXPECT_GT(testing::smallest_distance(walls), 0.05 * 9 / 10);
    for (const Vec& point : walls) {
      const double outside =
          std::max({-point.x(), point.x() - 1.03, -point.y(), open ? -1.0 : point.y() - 0.47});
      const double layer = outside / 0.05 - 0.5;
      EXPECT_NEAR(layer, std::round(layer), 1e-9) << point.transpose();
      EXPECT_GE(std::round(layer), 0);
      EXPECT_LE(std::round(layer), 2);
    }
  }
}

TEST(TankWalls, AreSpacedWholeAlongEachWall) {
  // 1.03 m / 0.05 m = 20.6 -> 21 columns, 0.47 / 0.05 = 9.4 -> 9 rows.
  const std::vector<Vec> walls = tank_walls({1.03, 0.47, {}, true}, method(0.05));
  std::set<double> floor, side;
  for (const Vec& point : walls) {
    const bool above_floor = point.y() > 0;
    if (!above_floor && point.x() > 0 && point.x() < 1.03) floor.insert(point.x());
    if (above_floor && point.x() < 0) side.insert(point.y());
  }
  ASSERT_EQ(floor.size(), 21U);
  ASSERT_EQ(side.size(), 9U);
  EXPECT_NEAR(*floor.begin(), 1.03 / 42, 1e-12);
  EXPECT_NEAR(*floor.rbegin(), 1.03 - 1.03 / 42, 1e-12);
  EXPECT_NEAR(*side.begin(), 0.47 / 18, 1e-12);
  EXPECT_NEAR(*side.rbegin(), 0.47 - 0.47 / 18, 1e-12);
}

TEST(TankWalls, FillTheCornersAndLeaveTheTopOpen) {
  const auto has = [](const std::vector<Vec>& walls, const Vec2& point) {
    return std::any_of(walls.begin(), walls.end(),
                       [&](const Vec2& each) { return (each - point).norm() < 1e-9; });
  };
  const std::vector<Vec> open = tank_walls({1, 0.5, {}, true}, method(0.05));
  const std::vector<Vec> closed = tank_walls({1, 0.5, {}, false}, method(0.05));
  EXPECT_TRUE(has(open, Vec2(-0.125, -0.125)));
  EXPECT_TRUE(has(open, Vec2(1.125, -0.125)));
  EXPECT_FALSE(has(open, Vec2(0.525, 0.525)));
  EXPECT_FALSE(has(open, Vec2(-0.025, 0.525)));
  EXPECT_TRUE(has(closed, Vec2(0.525, 0.525)));
  EXPECT_TRUE(has(closed, Vec2(1.125, 0.625)));
}

TEST(TankWalls, HoldTheKernelsSupport) {
  EXPECT_EQ(wall_layers(method(0.003)), 3);
  EXPECT_EQ(wall_layers(method(0.1, 0.8)), 3);
  EXPECT_EQ(wall_layers(method(0.1, 1.3)), 4);
  Method wendland = method(0.1, 1.5);
  wendland.kernel = KernelKind::wendland_c2;
  EXPECT_EQ(wall_layers(wendland), 3);
}

TEST(ObstacleWalls, FillASmallRectangleToItsFaces) {
  // 0.27 m = 5.4 cells -> 5 of 0.054 m; 0.1 m = 2 cells.
  const auto walls = obstacle_walls({Rectangle{Vec2(1, 2), Vec2(0.27, 0.1)}}, method(0.05));
  ASSERT_EQ(walls.size(), 10U);
  EXPECT_NEAR(walls.front().x(), 1.027, 1e-12);
  EXPECT_NEAR(walls.front().y(), 2.025, 1e-12);
  EXPECT_NEAR(walls.back().x(), 1.243, 1e-12);
  EXPECT_NEAR(walls.back().y(), 2.075, 1e-12);
}

TEST(ObstacleWalls, LeaveOutWhatIsDeeperThanThreeLayers) {
  // 20 x 30 cells less the 14 x 24 within.
  const auto walls = obstacle_walls({Rectangle{Vec2(0, 0), Vec2(1, 1.5)}}, method(0.05));
  EXPECT_EQ(walls.size(), 20U * 30U - 14U * 24U);
}

TEST(ObstacleWalls, KeepEveryPointNearTheSurfaceOfAThinEllipse) {
  const Vec2 axes(2, 0.3);
  const auto walls = obstacle_walls({Ellipse{Vec2(0, 0), axes}}, method(0.05));
  // Thirteen rows at the most, so the middle one is out of reach of the surface in columns only.
  std::set<std::pair<long, long>> cells;
  for (const Vec& point : walls) {
    EXPECT_LE(point.cwiseQuotient(axes).norm(), 1.0);
    cells.emplace(std::lround(point.x() / 0.05 - 0.5), std::lround(point.y() / 0.05 - 0.5));
  }
  EXPECT_EQ(cells.size(), walls.size());
  EXPECT_TRUE(cells.contains({0, 5}));
  EXPECT_TRUE(cells.contains({0, 3}));
  EXPECT_FALSE(cells.contains({0, 0}));
}

TEST(ObstacleWalls, OfOverlappingObstaclesStandOnce) {
  const std::vector<Shape> two = {Rectangle{Vec2(0, 0), Vec2(0.2, 0.2)},
                                  Rectangle{Vec2(0.1, 0.1), Vec2(0.2, 0.2)}};
  const auto walls = obstacle_walls(two, method(0.05));
  EXPECT_EQ(walls.size(), 16U + 12U);
  EXPECT_GT(testing::smallest_distance(walls), 0.049);
}

TEST(Rim, IsTheMiddleOfTheWallsHoweverThickTheyAre) {
  nlohmann::json text = testing::base_scene();
  EXPECT_DOUBLE_EQ(testing::parsed(text).domain.rim.min[0], -1.5 * 0.05);
  text["resolution"]["smoothing_ratio"] = 1.3;  // walls of four layers
  text["numerics"] = {{"scheme", "paper"}, {"courant", 0.1}};
  const Scene scene = testing::parsed(text);
  const std::int64_t layers = wall_layers(scene.method);
  ASSERT_EQ(layers % 2, 0);
  EXPECT_DOUBLE_EQ(scene.domain.rim.min[0], -0.5 * 0.05 * static_cast<double>(layers));
  EXPECT_DOUBLE_EQ(scene.domain.rim.max[0], 2.0 - scene.domain.rim.min[0]);
}

}  // namespace
}  // namespace sluice

#include "engine/scene/geometry/solids.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/scene/geometry/geometry.hpp"
#include "engine/scene/geometry/ways.hpp"
#include "tests/space/dimensions.hpp"

namespace sluice {

namespace {

constexpr double kSpacing = 0.1;

/// 2 m wide in every horizontal direction and 1 m high.
template <int Dim>
TankRoomN<Dim> room(bool open_top) {
  TankRoomN<Dim> result{VecN<Dim>::Constant(2.0), open_top};
  result.size[kUpAxis] = 1.0;
  return result;
}

/// In the middle of the room, at a height.
template <int Dim>
VecN<Dim> middle_at(double height) {
  VecN<Dim> result = VecN<Dim>::Ones();
  result[kUpAxis] = height;
  return result;
}

template <class Dimension>
class TankRooms : public ::testing::Test {};
TYPED_TEST_SUITE(TankRooms, testing::Dimensions);

TYPED_TEST(TankRooms, AreAsDeepInTheirWallsAsTheyAreFarFromTheOpen) {
  constexpr int kD = TypeParam::value;
  const TankRoomN<kD> tank = room<kD>(true);
  EXPECT_EQ(tank.depth_in_walls(middle_at<kD>(0.5)), 0.0);
  EXPECT_DOUBLE_EQ(tank.depth_in_walls(middle_at<kD>(-0.25)), 0.25) << "below the floor";
  for (const int side : {0, kD - 1}) {
    if (side == kUpAxis) continue;
    VecN<kD> beside = middle_at<kD>(0.5);
    beside[side] = 2.25;
    EXPECT_DOUBLE_EQ(tank.depth_in_walls(beside), 0.25) << side;
    beside[kUpAxis] = 0.875;
    EXPECT_DOUBLE_EQ(tank.depth_in_walls(beside), 0.125) << "a wall is left over its rim";
    beside[kUpAxis] = 1.125;
    EXPECT_EQ(tank.depth_in_walls(beside), 0.0) << "above the rim is the air";
    EXPECT_FALSE(tank.between_sides(beside));
  }
  EXPECT_DOUBLE_EQ(room<kD>(false).depth_in_walls(middle_at<kD>(1.25)), 0.25) << "in the lid";
}

TYPED_TEST(TankRooms, LeaveRoomFarFromTheirWallsOnly) {
  constexpr int kD = TypeParam::value;
  EXPECT_TRUE(room<kD>(true).leaves_room(middle_at<kD>(0.95), 0.1));
  EXPECT_FALSE(room<kD>(false).leaves_room(middle_at<kD>(0.95), 0.1)) << "below the lid";
  EXPECT_FALSE(room<kD>(true).leaves_room(middle_at<kD>(0.05), 0.1)) << "above the floor";
  VecN<kD> at_side = middle_at<kD>(0.5);
  at_side[0] = 0.05;
  EXPECT_FALSE(room<kD>(true).leaves_room(at_side, 0.1));
}

template <class Dimension>
class SolidsOf : public ::testing::Test {};
TYPED_TEST_SUITE(SolidsOf, testing::Dimensions);

TYPED_TEST(SolidsOf, CuboidsThatTouchAreOneSolid) {
  constexpr int kD = TypeParam::value;
  using Point = VecN<kD>;
  // Two cubes side by side, 1 m each.
  const std::vector<ShapeN<kD>> cubes{Cuboid<kD>{Point::Zero(), Point::Ones()},
                                      Cuboid<kD>{Point::Unit(0), Point::Ones()}};
  const SolidsN<kD> solids(cubes, std::nullopt, kSpacing);
  const Point seam = Point::Constant(0.5) + 0.5 * Point::Unit(0);
  EXPECT_TRUE(solids.holds(seam));
  EXPECT_NEAR(solids.depth(seam, 0.75), 0.5, 1e-6) << "the nearest face, not the seam";
  EXPECT_EQ(solids.depth(Point::Constant(1.5), 1.0), 0.0);
  EXPECT_TRUE(solids.leaves_room(Point::Constant(0.5) - Point::Unit(0), 0.4));
  EXPECT_FALSE(solids.leaves_room(Point::Constant(0.5) - Point::Unit(0), 0.6));
  const auto out = solids.reach(Point::Constant(0.5), Point::Unit(0), 5.0, 0.1);
  ASSERT_TRUE(out);
  EXPECT_NEAR(*out, 1.5, 1e-6);
}

template <class Dimension>
class WaysOf : public ::testing::Test {};
TYPED_TEST_SUITE(WaysOf, testing::Dimensions);

TYPED_TEST(WaysOf, GoStraightAndAlongEveryDiagonalInTheOpen) {
  constexpr int kD = TypeParam::value;
  const std::vector<ShapeN<kD>> nothing;
  const SolidsN<kD> solids(nothing, std::nullopt, kSpacing);
  WaysN<kD> ways(solids, kSpacing);
  ways.seek(VecN<kD>::Zero(), 4.0, 10.0);
  EXPECT_FALSE(ways.shut());
  EXPECT_FALSE(ways.miss_somebody(2.0));
  // In spacings; places are on nodes, half a spacing apart.
  EXPECT_NEAR(ways.length_to(kSpacing * 2.0 * VecN<kD>::Unit(0)).value(), 2.0, 1e-12);
  EXPECT_NEAR(ways.length_to(kSpacing * VecN<kD>::Ones()).value(), std::sqrt(kD), 1e-12);
}

TYPED_TEST(WaysOf, LeadRoundAPlateAndNotThroughIt) {
  constexpr int kD = TypeParam::value;
  using Point = VecN<kD>;
  // Across x, a spacing thick and 2 spacings to either side of the x axis.
  Cuboid<kD> plate{Point::Constant(-2.0 * kSpacing), Point::Constant(4.0 * kSpacing)};
  plate.corner[0] = -0.5 * kSpacing;
  plate.size[0] = kSpacing;
  const std::vector<ShapeN<kD>> solid{plate};
  const SolidsN<kD> solids(solid, std::nullopt, kSpacing);
  WaysN<kD> ways(solids, kSpacing);
  const Point from = -1.5 * kSpacing * Point::Unit(0);
  ways.seek(from, 5.0, 20.0);
  const double round = ways.length_to(-from).value();
  EXPECT_GT(round, 2.0 * std::hypot(1.5, 2.0)) << "shorter than round the edge";
  EXPECT_LT(round, 9.0);
  EXPECT_TRUE(std::isfinite(round));
  ways.seek(from, 1.75, 20.0);
  EXPECT_TRUE(std::isinf(ways.length_to(-0.75 * from).value_or(HUGE_VAL)));
}

}  // namespace
}  // namespace sluice

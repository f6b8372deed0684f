#include "engine/scene/filling/body_fill.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/scene/filling/body_fill-inl.hpp"
#include "tests/space/dimensions.hpp"

namespace sluice {
namespace {

constexpr double kCell = 0.25;

template <class Dimension>
class BodyFills : public ::testing::Test {};
TYPED_TEST_SUITE(BodyFills, testing::Dimensions);

template <int Dim>
Cuboid<Dim> cube(double from, double side) {
  return {VecN<Dim>::Constant(from), VecN<Dim>::Constant(side)};
}

TYPED_TEST(BodyFills, PutAsManyParticlesIntoARegionAsItsMeasureHolds) {
  constexpr int kD = TypeParam::value;
  const Ball<kD> ball{VecN<kD>::Ones(), 1.3};
  const BodyFillN<kD> fill({ball}, {}, std::nullopt, kCell);
  const double expected = measure(ball) / cell_measure<kD>(kCell);
  EXPECT_NEAR(static_cast<double>(fill.count(0)) / expected, 1.0, 0.01);
  const std::vector<VecN<kD>> places = fill.places(0);
  EXPECT_EQ(places.size(), fill.count(0));
  for (const VecN<kD>& place : places) EXPECT_LT(signed_distance(ball, place), 0.5 * kCell);
}

TYPED_TEST(BodyFills, LeaveOutWhatSolidsFill) {
  constexpr int kD = TypeParam::value;
  // A cube of 8 cells with a core of 4 along each axis.
  const Cuboid<kD> core = cube<kD>(0.5, 1.0);
  const BodyFillN<kD> fill({cube<kD>(0.0, 2.0)}, {core}, std::nullopt, kCell);
  EXPECT_EQ(fill.count(0), kD == 2 ? 64U - 16U : 512U - 64U);
  for (const VecN<kD>& place : fill.places(0)) EXPECT_FALSE(contains(core, place));
}

TYPED_TEST(BodyFills, SurroundFreeFacesAsFarAsPackingReaches) {
  constexpr int kD = TypeParam::value;
  const Cuboid<kD> water = cube<kD>(0.0, 2.0);
  const BodyFillN<kD> fill({water}, {}, std::nullopt, kCell);
  double volume = 0.0;
  for (const FixedPointN<kD>& each : fill.outside({0})) {
    EXPECT_GE(signed_distance(water, each.position), 0.0);
    volume += each.volume;
  }
  // A cube of 8 + 2 * 3 spacings less one of 8.
  EXPECT_NEAR(volume, std::pow(14.0, kD) - std::pow(8.0, kD), 1e-9);
}

TYPED_TEST(BodyFills, HaveNoOutsideInTheWallsOfATank) {
  constexpr int kD = TypeParam::value;
  const TankRoomN<kD> tank{VecN<kD>::Constant(2.0), true};
  const BodyFillN<kD> fill({cube<kD>(0.0, 2.0)}, {}, tank, kCell);
  double volume = 0.0;
  for (const FixedPointN<kD>& each : fill.outside({0})) {
    EXPECT_GT(each.position[kUpAxis], 2.0);
    volume += each.volume;
  }
  // The air above the rim, also above the walls.
  EXPECT_NEAR(volume, 3.0 * std::pow(14.0, kD - 1), 1e-9);
}

TEST(Intervals, AreMergedAndTakenAway) {
  EXPECT_EQ(merged({{3, 4}, {0, 1}, {1, 2}, {5, 5}}), (Intervals{{0, 2}, {3, 4}}));
  EXPECT_EQ(without({{0, 10}}, {{-1, 1}, {3, 4}, {9, 12}}), (Intervals{{1, 3}, {4, 9}}));
  EXPECT_EQ(length({{0, 2}, {3, 4}}), 3.0);
}

TEST(Intervals, HaveMiddlesOfEqualShares) {
  EXPECT_EQ(middles({{{0, 4}}}, 2), (std::vector<double>{1, 3}));
  EXPECT_EQ(middles({{{0, 1}, {2, 3}}}, 2), (std::vector<double>{0.5, 2.5}));
  // Two lines together have as much up to a height as one that is twice as wide.
  EXPECT_EQ(middles({{{0, 2}}, {{0, 2}}}, 1), (std::vector<double>{1}));
}

}  // namespace
}  // namespace sluice

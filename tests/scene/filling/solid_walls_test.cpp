#include "engine/scene/filling/solid_walls.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/scene/filling/cells-inl.hpp"
#include "engine/scene/filling/solid_walls-inl.hpp"
#include "tests/space/dimensions.hpp"

namespace sluice {
namespace {

template <class Dimension>
class SolidWalls : public ::testing::Test {};
TYPED_TEST_SUITE(SolidWalls, testing::Dimensions);

constexpr WallLayers kLayers{0.25, 3};

/// 4 cells along x, 5 upwards and, in space, 6 along z.
template <int Dim>
TankRoomN<Dim> walled_room(bool open_top) {
  TankRoomN<Dim> result{VecN<Dim>::Zero(), open_top};
  for (int axis = 0; axis < Dim; ++axis) result.size[axis] = kLayers.spacing * (4 + axis);
  return result;
}

TYPED_TEST(SolidWalls, SurroundATankInWholeLayers) {
  constexpr int kD = TypeParam::value;
  for (const bool open_top : {true, false}) {
    const TankRoomN<kD> tank = walled_room<kD>(open_top);
    const std::vector<VecN<kD>> walls = walls_around(tank, kLayers);
    // The box of all cells less the inside: 3 layers on each side, none above an open top.
    const std::size_t up = open_top ? 8 : 11;
    const std::size_t inside = kD == 2 ? 4 * 5 : 4 * 5 * 6;
    EXPECT_EQ(walls.size(), 10 * up * (kD == 2 ? 1 : 12) - inside);
    EXPECT_EQ(count_walls_around(tank, kLayers), static_cast<double>(walls.size()));
    const BoxN<kD> box{VecN<kD>::Zero(), tank.size};
    for (const VecN<kD>& point : walls) {
      EXPECT_FALSE(box.contains(point));
      EXPECT_TRUE(grown(box, 0.75).contains(point));
      EXPECT_LT(point[kUpAxis], tank.size[kUpAxis] + (open_top ? 0.0 : 0.75));
    }
  }
}

TYPED_TEST(SolidWalls, AreTheOuterCellsOfASolid) {
  constexpr int kD = TypeParam::value;
  const std::vector<ShapeN<kD>> cube{Cuboid<kD>{VecN<kD>::Zero(), VecN<kD>::Constant(2.5)}};
  const auto none = [](std::size_t) { return std::nullopt; };
  // 10 cells along each axis, a core of 4 of which is left out.
  EXPECT_EQ(walls_of_solids<kD>(cube, kLayers, none).size(), kD == 2 ? 100U - 16U : 1000U - 64U);
}

TYPED_TEST(SolidWalls, AreThoseOfTheFirstSolidWhereTwoOverlap) {
  constexpr int kD = TypeParam::value;
  const Cuboid<kD> cube{VecN<kD>::Zero(), VecN<kD>::Ones()};
  const auto none = [](std::size_t) { return std::nullopt; };
  const std::size_t one = walls_of_solids<kD>({cube}, kLayers, none).size();
  EXPECT_EQ(walls_of_solids<kD>({cube, cube}, kLayers, none).size(), one);
}

TYPED_TEST(SolidWalls, AreTheirOwnWhereTheyHaveSome) {
  constexpr int kD = TypeParam::value;
  const Cuboid<kD> cube{VecN<kD>::Zero(), VecN<kD>::Ones()};
  const std::vector<VecN<kD>> own{VecN<kD>::Constant(0.5)};
  EXPECT_EQ(walls_of_solids<kD>({cube}, kLayers, [&](std::size_t) { return std::optional(own); }),
            own);
}

}  // namespace
}  // namespace sluice

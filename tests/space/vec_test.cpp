#include "engine/space/vec.hpp"

#include <gtest/gtest.h>

#include "tests/space/dimensions.hpp"

namespace sluice {
namespace {

template <class Dimension>
class Boxes : public ::testing::Test {};
TYPED_TEST_SUITE(Boxes, testing::Dimensions);

/// [0, 2]^d.
template <int Dim>
BoxN<Dim> box() {
  return {VecN<Dim>::Zero(), VecN<Dim>::Constant(2.0)};
}

TYPED_TEST(Boxes, ContainWhatIsInsideOnEveryAxis) {
  using Point = VecN<TypeParam::value>;
  const auto cube = box<TypeParam::value>();
  EXPECT_TRUE(cube.contains(Point::Ones()));
  EXPECT_TRUE(cube.contains(Point::Zero())) << "a corner";
  for (int axis = 0; axis < TypeParam::value; ++axis) {
    EXPECT_FALSE(cube.contains(Point::Ones() + 1.5 * Point::Unit(axis))) << axis;
    EXPECT_FALSE(cube.contains(Point::Ones() - 1.5 * Point::Unit(axis))) << axis;
  }
}

TYPED_TEST(Boxes, HaveASizeAndAMiddle) {
  using Point = VecN<TypeParam::value>;
  EXPECT_EQ(box<TypeParam::value>().size(), Point::Constant(2.0));
  EXPECT_EQ(box<TypeParam::value>().middle(), Point::Ones());
}

TYPED_TEST(Boxes, GrowOnAllSides) {
  using Point = VecN<TypeParam::value>;
  const auto cube = box<TypeParam::value>();
  EXPECT_EQ(grown(cube, 0.5).min, Point::Constant(-0.5));
  EXPECT_EQ(grown(cube, 0.5).max, Point::Constant(2.5));
  EXPECT_EQ(grown(cube, -0.5).size(), Point::Ones());
}

TYPED_TEST(Boxes, OverlapUnlessOneAxisPartsThem) {
  const auto cube = box<TypeParam::value>();
  for (int axis = 0; axis < TypeParam::value; ++axis) {
    auto other = cube;
    other.min[axis] += 2.0;
    other.max[axis] += 2.0;
    EXPECT_TRUE(overlap(cube, other)) << "they touch, axis " << axis;
    other.min[axis] += 0.01;
    EXPECT_FALSE(overlap(cube, other)) << axis;
  }
}

TYPED_TEST(Boxes, GrowByThePointsThatTheyTakeIn) {
  using Point = VecN<TypeParam::value>;
  auto cube = box<TypeParam::value>();
  cube.take_in(3.0 * Point::Unit(0));
  cube.take_in(-1.0 * Point::Unit(1));
  EXPECT_EQ(cube.max, Point(Point::Constant(2.0) + Point::Unit(0)));
  EXPECT_EQ(cube.min, Point(-1.0 * Point::Unit(1)));
}

}  // namespace
}  // namespace sluice

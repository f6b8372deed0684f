#include "engine/scene/geometry/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "engine/scene/geometry/geometry.hpp"
#include "tests/space/dimensions.hpp"

namespace sluice {
namespace {

template <class Dimension>
class Shapes : public ::testing::Test {};
TYPED_TEST_SUITE(Shapes, testing::Dimensions);

/// The box [1, 3] x [1, 4] x [1, 5], as far as there are axes.
template <int Dim>
Cuboid<Dim> cuboid() {
  Cuboid<Dim> result{VecN<Dim>::Ones(), {}};
  for (int axis = 0; axis < Dim; ++axis) result.size[axis] = 2.0 + axis;
  return result;
}

/// About (1, 1, ...), with semi-axes 1, 2 and 3.
template <int Dim>
Ellipsoid<Dim> ellipsoid() {
  Ellipsoid<Dim> result{VecN<Dim>::Ones(), {}};
  for (int axis = 0; axis < Dim; ++axis) result.semi_axes[axis] = 1.0 + axis;
  return result;
}

TYPED_TEST(Shapes, MeasuresAreThoseOfTheTextbook) {
  constexpr int kD = TypeParam::value;
  const double pi = std::numbers::pi;
  EXPECT_DOUBLE_EQ(measure(cuboid<kD>()), kD == 2 ? 6.0 : 24.0);
  EXPECT_DOUBLE_EQ(measure(Ball<kD>{VecN<kD>::Ones(), 2.0}), kD == 2 ? 4 * pi : 32 * pi / 3);
  EXPECT_DOUBLE_EQ(measure(ellipsoid<kD>()), kD == 2 ? 2 * pi : 8 * pi);
}

TYPED_TEST(Shapes, DistancesAreExactWhereTheyAreKnown) {
  constexpr int kD = TypeParam::value;
  using Point = VecN<kD>;
  const Cuboid<kD> cube{Point::Zero(), Point::Constant(2.0)};
  EXPECT_DOUBLE_EQ(signed_distance(cube, Point::Ones()), -1.0);
  EXPECT_DOUBLE_EQ(signed_distance(cube, Point::Ones() + 3.0 * Point::Unit(kD - 1)), 2.0);
  EXPECT_DOUBLE_EQ(signed_distance(cube, Point::Constant(5.0)), 3.0 * std::sqrt(kD)) << "a corner";
  const Ball<kD> ball{Point::Ones(), 2.0};
  EXPECT_DOUBLE_EQ(signed_distance(ball, Point::Ones()), -2.0);
  EXPECT_DOUBLE_EQ(signed_distance(ball, Point::Ones() + 5.0 * Point::Unit(kD - 1)), 3.0);
  for (int axis = 0; axis < kD; ++axis) {
    const Point along = Point::Ones() + (axis + 1.5) * Point::Unit(axis);
    EXPECT_DOUBLE_EQ(signed_distance(ellipsoid<kD>(), along), 0.5) << axis;
  }
}

TYPED_TEST(Shapes, DistanceIsNegativeExactlyInside) {
  constexpr int kD = TypeParam::value;
  const std::vector<ShapeN<kD>> shapes{cuboid<kD>(), Ball<kD>{VecN<kD>::Ones(), 1.5},
                                       ellipsoid<kD>()};
  std::mt19937 dice(1);
  std::uniform_real_distribution<double> somewhere(-4.0, 6.0);
  for (int k = 0; k < 1000; ++k) {
    VecN<kD> point;
    for (double& each : point) each = somewhere(dice);
    for (const ShapeN<kD>& shape : shapes) {
      const double distance = signed_distance(shape, point);
      ASSERT_EQ(contains(shape, point), distance < 0.0) << point.transpose();
      ASSERT_TRUE(distance > 0.0 || bounds(shape).contains(point)) << point.transpose();
    }
  }
}

TYPED_TEST(Shapes, AreFarthestWhereTheirTangentStandsAcross) {
  constexpr int kD = TypeParam::value;
  using Point = VecN<kD>;
  const Point direction = Point::Ones().normalized();
  // About the origin: the farthest corner, the radius, and sqrt(sum (a_k n_k)^2).
  const double of_corner = kD == 2 ? 3.0 + 4.0 : 3.0 + 4.0 + 5.0;
  EXPECT_DOUBLE_EQ(farthest_along(cuboid<kD>(), direction), of_corner / std::sqrt(kD));
  EXPECT_DOUBLE_EQ(farthest_along(Ball<kD>{Point::Zero(), 3.0}, direction), 3.0);
  const double of_axes = kD == 2 ? 1.0 + 4.0 : 1.0 + 4.0 + 9.0;
  EXPECT_DOUBLE_EQ(farthest_along(ellipsoid<kD>(), direction),
                   std::sqrt(kD) + std::sqrt(of_axes / kD));
}

TYPED_TEST(Shapes, ChordsAreWhereALineEntersAndLeaves) {
  constexpr int kD = TypeParam::value;
  using Point = VecN<kD>;
  const Ball<kD> ball{Point::Ones(), 2.0};
  const std::vector<double> through = chords(ball, Point::Zero(), Point::Ones());
  ASSERT_EQ(through.size(), 2U);
  EXPECT_NEAR(through[0], 1.0 - 2.0 / std::sqrt(kD), 1e-14);
  EXPECT_NEAR(through[1], 1.0 + 2.0 / std::sqrt(kD), 1e-14);
  EXPECT_TRUE(chords(ball, Point(4.0 * Point::Unit(1)), Point::Unit(0)).empty());
  const Cuboid<kD> cube{Point::Ones(), Point::Ones()};
  const std::vector<double> diagonal = chords(cube, Point::Zero(), Point::Ones());
  ASSERT_EQ(diagonal.size(), 2U);
  EXPECT_NEAR(diagonal[0], 1.0, 1e-14);
  EXPECT_NEAR(diagonal[1], 2.0, 1e-14);
  const Point below = Point::Constant(1.25) - 3.0 * Point::Unit(kUpAxis);
  EXPECT_EQ(chords(cube, below, Point::Unit(kUpAxis)), (std::vector<double>{2.75, 3.75}));
  EXPECT_TRUE(chords(cube, Point(below + Point::Unit(0)), Point::Unit(kUpAxis)).empty());
}

TEST(RectangleChords, AreThoseOfACuboid) {
  const Rectangle rectangle{Vec2(1.0, 2.0), Vec2(3.0, 1.0)};
  for (int k = 0; k < 100; ++k) {
    const Vec2 direction(std::cos(0.1 * k), std::sin(0.1 * k));
    const Vec2 origin(2.0 + std::sin(k), 2.5 + std::cos(k));
    const std::vector<double> outline = chords(rectangle, origin, direction);
    const std::vector<double> slabs = chords<2>(rectangle, origin, direction);
    ASSERT_EQ(outline.size(), slabs.size()) << k;
    for (std::size_t n = 0; n < slabs.size(); ++n) EXPECT_NEAR(outline[n], slabs[n], 1e-12) << k;
  }
}

}  // namespace
}  // namespace sluice

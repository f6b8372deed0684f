#include "engine/scene/filling/cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/scene/filling/cells-inl.hpp"
#include "tests/space/dimensions.hpp"

namespace sluice {
namespace {

template <class Dimension>
class Cells : public ::testing::Test {};
TYPED_TEST_SUITE(Cells, testing::Dimensions);

/// A cube of 1 m that starts at (2, 2, ...).
template <int Dim>
Cuboid<Dim> cube() {
  return {VecN<Dim>::Constant(2.0), VecN<Dim>::Ones()};
}

TYPED_TEST(Cells, FillACuboidFromItsLowestCorner) {
  constexpr int kD = TypeParam::value;
  const CellSetN<kD> cells(cube<kD>(), 0.25, CellFit::exact_spacing);
  EXPECT_EQ(cells.size(), kD == 2 ? 16U : 64U);
  std::vector<VecN<kD>> centers;
  cells.for_each([&](const VecN<kD>& center, const auto&) { centers.push_back(center); });
  ASSERT_EQ(centers.size(), cells.size());
  EXPECT_EQ(centers[0], VecN<kD>::Constant(2.125));
  EXPECT_EQ(centers[1], VecN<kD>(VecN<kD>::Constant(2.125) + 0.25 * VecN<kD>::Unit(0)));
  EXPECT_EQ(centers[4], VecN<kD>(VecN<kD>::Constant(2.125) + 0.25 * VecN<kD>::Unit(1)));
}

TYPED_TEST(Cells, AreStretchedToFitACuboid) {
  constexpr int kD = TypeParam::value;
  const CellSetN<kD> cells(cube<kD>(), 0.3, CellFit::stretched);
  EXPECT_EQ(cells.size(), kD == 2 ? 9U : 27U);
  cells.for_each([&](const VecN<kD>& center, const auto& cell) {
    const VecN<kD> expected =
        VecN<kD>::Constant(2.0) + (as_vector<kD>(cell).array() + 0.5).matrix() / 3;
    EXPECT_LT((center - expected).norm(), 1e-14);
  });
}

TYPED_TEST(Cells, OfABallAreThoseOfTheOriginsLatticeWhoseCentresItHolds) {
  constexpr int kD = TypeParam::value;
  const Ball<kD> ball{VecN<kD>::Constant(0.3), 1.0};
  const double dx = 0.1;
  const CellSetN<kD> cells(ball, dx, CellFit::exact_spacing);
  std::size_t expected = 0;
  for_each_cell<kD>(shifted<kD>({}, -20), shifted<kD>({}, 20), [&](const CellN<kD>& cell) {
    const VecN<kD> center = dx * (as_vector<kD>(cell).array() + 0.5).matrix();
    if ((center - ball.center).norm() <= ball.radius) ++expected;
  });
  EXPECT_EQ(cells.size(), expected);
  const double by_measure = measure(ball) / cell_measure<kD>(dx);
  EXPECT_NEAR(static_cast<double>(cells.size()) / by_measure, 1.0, 0.02);
  cells.for_each([&](const VecN<kD>& center, const auto&) {
    EXPECT_LT((center - ball.center).norm(), ball.radius);
    EXPECT_TRUE(cells.covers(center));
  });
}

TYPED_TEST(Cells, AreDeepWhereOthersLieAroundThemOnAllSides) {
  constexpr int kD = TypeParam::value;
  const CellSetN<kD> cells(cube<kD>(), 0.1, CellFit::exact_spacing);
  std::size_t deep = 0;
  cells.for_each([&](const VecN<kD>&, const auto& cell) {
    if (cells.is_deep(cell, 3)) ++deep;
  });
  EXPECT_EQ(deep, kD == 2 ? 16U : 64U) << "those of a core of 4 cells along each axis";
}

TYPED_TEST(Cells, CoverTheirBoundaryOnlyWhereBothSidesAreIn) {
  constexpr int kD = TypeParam::value;
  using Point = VecN<kD>;
  const CellSetN<kD> cells(cube<kD>(), 0.25, CellFit::exact_spacing);
  EXPECT_TRUE(cells.covers(Point::Constant(2.5))) << "between cells";
  EXPECT_FALSE(cells.covers(Point::Constant(2.0))) << "on a face";
  for (int axis = 0; axis < kD; ++axis) {
    EXPECT_FALSE(cells.covers(Point(Point::Constant(2.5) + 0.6 * Point::Unit(axis)))) << axis;
  }
}

}  // namespace
}  // namespace sluice

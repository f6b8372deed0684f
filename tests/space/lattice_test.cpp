#include "engine/space/lattice.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace sluice {
namespace {

template <int Dim>
std::vector<CellN<Dim>> cells(const CellN<Dim>& first, const CellN<Dim>& last) {
  std::vector<CellN<Dim>> result;
  for_each_cell<Dim>(first, last, [&](const CellN<Dim>& cell) { result.push_back(cell); });
  return result;
}

TEST(Lattice, CellsComeRowByRowInThePlane) {
  const std::vector<CellN<2>> expected{{1, 5}, {2, 5}, {1, 6}, {2, 6}, {1, 7}, {2, 7}};
  EXPECT_EQ(cells<2>({1, 5}, {2, 7}), expected);
}

TEST(Lattice, RowsOfSpaceAreNumberedByZThenByY) {
  const std::vector<CellN<3>> expected{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                       {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  EXPECT_EQ(cells<3>({0, 0, 0}, {1, 1, 1}), expected);
}

TEST(Lattice, CellsAreCountedInTheOrderInWhichTheyCome) {
  const CellN<3> first{-1, 2, 0}, last{1, 4, 1};
  std::size_t place = 0;
  for (const CellN<3>& cell : cells<3>(first, last)) {
    EXPECT_EQ(index_between<3>(first, last, cell), place++);
  }
  EXPECT_EQ(place, 18U);
}

TEST(Lattice, HasNoCellsWhereAnAxisHasNone) {
  EXPECT_TRUE(cells<2>({0, 0}, {-1, 3}).empty());
  EXPECT_TRUE(cells<3>({0, 0, 0}, {3, 3, -1}).empty());
}

TEST(Lattice, APointLiesInTheCellBelowIt) {
  EXPECT_EQ(cell_at<2>({0.5, -0.5}), (CellN<2>{0, -1}));
  EXPECT_EQ(cell_at<3>({2.0, 0.0, -1e-9}), (CellN<3>{2, 0, -1}));
}

TEST(Lattice, CellsAreShiftedAlongEveryAxis) {
  EXPECT_EQ(shifted<3>({1, 2, 3}, -2), (CellN<3>{-1, 0, 1}));
  EXPECT_EQ(as_vector<2>({3, -4}), VecN<2>(3.0, -4.0));
}

}  // namespace
}  // namespace sluice

#include "engine/sph/stability/neighbour_count.hpp"

#include <gtest/gtest.h>

#include "engine/space/lattice.hpp"
#include "tests/space/dimensions.hpp"

namespace sluice {
namespace {

template <class Dimension>
class NeighbourCount : public ::testing::Test {};
TYPED_TEST_SUITE(NeighbourCount, testing::Dimensions);

TYPED_TEST(NeighbourCount, OfALatticeIsThatOfItsPoints) {
  constexpr int kD = TypeParam::value;
  CellN<kD> first;
  first.fill(-4);
  CellN<kD> last;
  last.fill(4);
  for (const int most_sq : {0, 1, 2, 8, 9, 16}) {
    std::uint32_t points = 0;
    for_each_cell<kD>(first, last, [&](const CellN<kD>& cell) {
      if (as_vector<kD>(cell).squaredNorm() <= most_sq) ++points;
    });
    EXPECT_EQ(lattice_points<kD>(most_sq), points) << most_sq;
  }
}

TYPED_TEST(NeighbourCount, IsLargeAtTheSameMultipleOfALatticesInThePlaneAndInSpace) {
  constexpr int kD = TypeParam::value;
  EXPECT_NEAR(kManyNeighbours<kD>, 200.0 / 28.0 * kLatticeNeighbours<kD>, 1.0);
}

TEST(NeighbourCountOfThePapersSupport, Is28InThePlaneAnd122InSpace) {
  EXPECT_EQ(kLatticeNeighbours<2>, 28U);
  EXPECT_EQ(kLatticeNeighbours<3>, 122U);
  EXPECT_EQ(kManyNeighbours<2>, 200U);
  EXPECT_EQ(kManyNeighbours<3>, 871U);
}

}  // namespace
}  // namespace sluice

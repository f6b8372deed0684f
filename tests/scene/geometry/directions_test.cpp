#include "engine/scene/geometry/directions.hpp"

#include <gtest/gtest.h>

namespace sluice {
namespace {

TEST(Directions, AreSpreadEvenlyRoundThePlane) {
  const std::vector<VecN<2>> ways = directions<2>(12);
  ASSERT_EQ(ways.size(), 12U);
  EXPECT_EQ(ways[0], VecN<2>(1.0, 0.0));
  EXPECT_NEAR((ways[3] - VecN<2>(0.0, 1.0)).norm(), 0.0, 1e-15) << "a quarter of the way round";
  const double step = std::cos(2 * std::numbers::pi / 12);
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_NEAR(ways[k].norm(), 1.0, 1e-15);
    EXPECT_NEAR(ways[k].dot(ways[(k + 1) % 12]), step, 1e-15);
  }
}

TEST(Directions, BeginWhereTheyAreTold) {
  const double half_a_step = std::numbers::pi / 4;
  const VecN<2> first = directions<2>(4, 0.5).front();
  EXPECT_NEAR((first - VecN<2>(std::cos(half_a_step), std::sin(half_a_step))).norm(), 0.0, 1e-15);
}

TEST(Directions, AreOneOfEachLineInTheirHalf) {
  const std::vector<VecN<2>> ways = half_of_directions<2>(8);
  ASSERT_EQ(ways.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_LT(std::abs(ways[i].dot(ways[j])), 0.99);
  }
}

}  // namespace
}  // namespace sluice

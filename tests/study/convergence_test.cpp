#include "engine/study/convergence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace sluice {
namespace {

/// value = limit + factor spacing^order, the finest first.
std::vector<Refined> power_law(std::vector<double> spacings, double limit, double factor,
                               double order) {
  std::vector<Refined> points;
  for (const double spacing : spacings) {
    points.push_back({spacing, limit + factor * std::pow(spacing, order)});
  }
  return points;
}

TEST(Richardson, FindsOrderAndLimitOfAPowerLaw) {
  const auto found = richardson(power_law({0.25, 0.5, 1.0}, 3.0, -0.5, 2.0));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->approach, Approach::monotone);
  EXPECT_NEAR(*found->order, 2.0, 1e-9);
  EXPECT_NEAR(*found->extrapolated, 3.0, 1e-12);
}

TEST(Richardson, NeedsNoConstantRatio) {
  const auto found = richardson(power_law({1.0, 1.5, 2.4}, 7.0, 0.2, 1.3));
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found->order, 1.3, 1e-9);
  EXPECT_NEAR(*found->extrapolated, 7.0, 1e-9);
}

TEST(Richardson, UsesTheThreeFinestSpacings) {
  auto points = power_law({0.25, 0.5, 1.0}, 3.0, 1.0, 1.0);
  points.push_back({2.0, -40.0});
  EXPECT_NEAR(*richardson(points)->order, 1.0, 1e-9);
}

// Roache's example: GCI = 1.25 abs(e21/f1)/(r^p - 1).
TEST(Richardson, GivesTheGridConvergenceIndex) {
  const auto found =
      richardson(std::vector<Refined>{{1.0, 0.97050}, {2.0, 0.96854}, {4.0, 0.96178}});
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found->order, std::log(0.00676 / 0.00196) / std::log(2.0), 1e-9);
  EXPECT_NEAR(*found->extrapolated, 0.97130, 1e-5);
  EXPECT_NEAR(*found->gci, 0.00103, 1e-5);
}

TEST(Richardson, ClaimsNoOrderWhereValuesOscillateOrDiverge) {
  const auto oscillating = richardson(std::vector<Refined>{{1.0, 1.0}, {2.0, 1.2}, {4.0, 0.9}});
  EXPECT_EQ(oscillating->approach, Approach::oscillating);
  EXPECT_FALSE(oscillating->order);
  const auto diverging = richardson(std::vector<Refined>{{1.0, 1.0}, {2.0, 1.5}, {4.0, 1.6}});
  EXPECT_EQ(diverging->approach, Approach::diverging);
  EXPECT_FALSE(diverging->extrapolated);
  const auto settled = richardson(std::vector<Refined>{{1.0, 1.0}, {2.0, 1.0}, {4.0, 1.6}});
  EXPECT_EQ(settled->approach, Approach::settled);
}

TEST(Richardson, NeedsThreeSpacings) {
  EXPECT_FALSE(richardson(power_law({1.0, 2.0}, 0.0, 1.0, 1.0)));
}

TEST(OrderOfErrors, IsTheSlopeOfTheLogarithms) {
  EXPECT_NEAR(*order_of_errors(power_law({0.1, 0.3, 0.5, 1.0}, 0.0, 4.0, 1.7)), 1.7, 1e-12);
}

TEST(OrderOfErrors, IsNoneForAnErrorOfZeroOrOneSpacing) {
  EXPECT_FALSE(order_of_errors(std::vector<Refined>{{1.0, 0.0}, {2.0, 1.0}}));
  EXPECT_FALSE(order_of_errors(std::vector<Refined>{{1.0, 1.0}, {1.0, 2.0}}));
  EXPECT_FALSE(order_of_errors(std::vector<Refined>{{1.0, 1.0}}));
}

}  // namespace
}  // namespace sluice

#include "engine/verify/elliptical_drop.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sluice {
namespace {

/// s' at s: the equation that drop_stretch() must solve.
double rate_at(double s) { return std::sqrt(2.0 / (1.0 + std::pow(s, -4))); }

TEST(EllipticalDrop, StartsRoundAndSolvesItsEquation) {
  EXPECT_DOUBLE_EQ(drop_stretch(0.0), 1.0);
  constexpr double kStep = 1e-3;
  for (const double time : {0.1, 0.4, 0.8}) {
    const double slope = (drop_stretch(time + kStep) - drop_stretch(time - kStep)) / (2 * kStep);
    EXPECT_NEAR(slope, rate_at(drop_stretch(time)), 1e-5) << time;
  }
}

TEST(EllipticalDrop, OrderOfMadeUpErrorsIsTheOneTheyWereMadeWith) {
  std::vector<DropPoint> points;
  for (const double spacing : {0.1, 0.05, 0.025, 0.0125}) {
    points.push_back({spacing, 2.0 * (1.0 + 0.3 * std::pow(spacing, 1.5)), 2.0, 100.0});
  }
  const DropOrder order = order_of(points);
  EXPECT_NEAR(*order.order, 1.5, 1e-9);
  EXPECT_NEAR(*order.richardson->order, 1.5, 1e-9);
  EXPECT_NEAR(*order.richardson->extrapolated, 1.0, 1e-9);
  EXPECT_EQ(drop_table(points).rows.size(), 4u);
}

}  // namespace
}  // namespace sluice

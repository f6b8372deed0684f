#include "engine/report/measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sluice {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<double> range(double from, double step, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(from + step * i);
  return values;
}

template <typename Function>
Curve sampled(double from, double to, int count, Function&& function) {
  Curve curve;
  for (int i = 0; i <= count; ++i) {
    curve.time.push_back(from + (to - from) * i / count);
    curve.value.push_back(function(curve.time.back()));
  }
  return curve;
}

TEST(Intervals, ReachHalfWayToTheNeighboursAndAreSymmetricAtTheEnds) {
  const Intervals intervals({1.0, 2.0, 2.5});
  EXPECT_DOUBLE_EQ(intervals.begin(0), 0.5);
  EXPECT_DOUBLE_EQ(intervals.end(0), 1.5);
  EXPECT_DOUBLE_EQ(intervals.end(1), 2.25);
  EXPECT_DOUBLE_EQ(intervals.end(2), 2.75);
  EXPECT_DOUBLE_EQ(intervals.width(1), 0.75);
}

TEST(Intervals, RefuseTimesThatDoNotIncrease) {
  EXPECT_THROW(Intervals({1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(Intervals({1.0}), std::invalid_argument);
  EXPECT_THROW(Intervals({1.0, kNan}), std::invalid_argument);
}

TEST(IntervalAverages, OfALineAreItsValuesAtTheMiddleOfEachInterval) {
  // Sample times that are no edges of the intervals: the pieces must be cut.
  const Curve line = sampled(0.0, 4.0, 7, [](double t) { return 3.0 * t - 1.0; });
  const Intervals intervals({1.0, 2.0, 2.5, 3.0});
  const auto averages = interval_averages(line, intervals);
  for (std::size_t k = 0; k < intervals.size(); ++k) {
    EXPECT_NEAR(averages[k], 3.0 * 0.5 * (intervals.begin(k) + intervals.end(k)) - 1.0, 1e-14);
  }
}

TEST(IntervalAverages, OfATriangleInsideOneIntervalIsItsAreaByTheWidth) {
  const Curve triangle{{0.0, 1.9, 2.0, 2.2, 4.0}, {0.0, 0.0, 5.0, 0.0, 0.0}};
  const auto averages = interval_averages(triangle, Intervals({1.0, 2.0, 3.0}));
  EXPECT_NEAR(averages[0], 0.0, 1e-15);
  EXPECT_NEAR(averages[1], 0.5 * 0.3 * 5.0, 1e-14);
  EXPECT_NEAR(averages[2], 0.0, 1e-15);
}

TEST(IntervalAverages, AreCutAtTheBeginningOfTheCurveAndMissingAfterItsEnd) {
  const Curve line = sampled(0.0, 2.6, 26, [](double t) { return t; });
  const auto averages = interval_averages(line, Intervals({-1.0, 0.0, 1.0, 2.0, 3.0}));
  EXPECT_TRUE(std::isnan(averages[0]));
  EXPECT_NEAR(averages[1], 0.25, 1e-14);
  EXPECT_NEAR(averages[3], 2.0, 1e-14);
  EXPECT_TRUE(std::isnan(averages[4]));
  for (const double value : interval_averages({}, Intervals({0.0, 1.0}))) {
    EXPECT_TRUE(std::isnan(value));
  }
}

TEST(RelativeL2, IsZeroForEqualAndThePartForAProportionalSeries) {
  const Intervals intervals(range(2.4, 0.1, 40));
  std::vector<double> reference, simulated;
  for (const double t : intervals.centers()) {
    reference.push_back(std::sin(t));
    simulated.push_back(1.3 * std::sin(t));
  }
  EXPECT_DOUBLE_EQ(*relative_l2(intervals, reference, reference, {2.3, 7.05}), 0.0);
  EXPECT_NEAR(*relative_l2(intervals, simulated, reference, {2.3, 7.05}), 0.3, 1e-14);
}

TEST(RelativeL2, WeighsByTheWidthOfTheIntervals) {
  // Widths 1, 1.5, 2: differences only in the last interval, reference 1 everywhere.
  const Intervals intervals({1.0, 2.0, 4.0});
  const std::vector<double> reference{1.0, 1.0, 1.0};
  const std::vector<double> simulated{1.0, 1.0, 2.0};
  EXPECT_NEAR(*relative_l2(intervals, simulated, reference, {0.0, 9.0}), std::sqrt(2.0 / 4.5),
              1e-14);
}

TEST(RelativeL2, LooksOnlyAtTheWindowAndIsMissingWhereTheRunHasNoValue) {
  const Intervals intervals({1.0, 2.0, 3.0});
  const std::vector<double> reference{1.0, 1.0, 1.0};
  const std::vector<double> simulated{kNan, 1.5, kNan};
  EXPECT_NEAR(*relative_l2(intervals, simulated, reference, {1.5, 2.5}), 0.5, 1e-14);
  EXPECT_FALSE(relative_l2(intervals, simulated, reference, {1.5, 3.5}));
  EXPECT_FALSE(relative_l2(intervals, simulated, reference, {7.0, 8.0}));
}

TEST(RmsDifference, OfAConstantOffsetIsTheOffset) {
  const Intervals intervals({1.0, 2.0, 4.0});
  const std::vector<double> reference{1.0, 5.0, -2.0};
  const std::vector<double> simulated{1.25, 5.25, -1.75};
  EXPECT_NEAR(*rms_difference(intervals, simulated, reference, {0.0, 9.0}), 0.25, 1e-14);
}

TEST(IntegralAndMean, WeighByWidth) {
  const Intervals intervals({1.0, 2.0, 4.0});
  const std::vector<double> values{2.0, 4.0, 6.0};
  EXPECT_NEAR(*integral(intervals, values, {0.0, 9.0}), 2.0 + 6.0 + 12.0, 1e-14);
  EXPECT_NEAR(*mean(intervals, values, {0.0, 9.0}), 20.0 / 4.5, 1e-14);
  EXPECT_NEAR(*mean(intervals, values, {3.0, 9.0}), 6.0, 1e-14);
}

TEST(FirstPassage, LiesOnTheLineBetweenTwoSamples) {
  const Curve curve{{0.0, 1.0, 2.0, 3.0}, {0.0, 0.0, 1.0, 0.0}};
  EXPECT_DOUBLE_EQ(*first_passage(curve, 0.25, 0.0), 1.25);
  EXPECT_FALSE(first_passage(curve, 1.5, 0.0));
  EXPECT_FALSE(first_passage(curve, 0.5, 2.5));
  EXPECT_FALSE(first_passage({}, 0.5, 0.0));
}

TEST(FirstPassage, IsAtOnceWhenTheCurveIsAboveTheLevelAlready) {
  const Curve curve{{0.0, 1.0, 2.0}, {1.0, 1.0, 1.0}};
  EXPECT_DOUBLE_EQ(*first_passage(curve, 0.5, -1.0), 0.0);
  EXPECT_DOUBLE_EQ(*first_passage(curve, 0.5, 0.5), 0.5);
}

TEST(PeakOfACurve, IsTheHighestPointInsideTheWindowOnly) {
  const Curve curve{{0.0, 1.0, 2.0, 3.0, 4.0}, {0.0, 3.0, 1.0, 2.0, 9.0}};
  const auto inside = peak(curve, {1.5, 3.5});
  ASSERT_TRUE(inside);
  EXPECT_DOUBLE_EQ(inside->time, 3.0);
  EXPECT_DOUBLE_EQ(inside->value, 2.0);
  EXPECT_FALSE(peak(curve, {1.5, 5.0})) << "the curve ends inside the window";
}

/// 0.6, then a straight ramp over `length` from `start` to `height`, then constant.
std::vector<double> ramp(const Intervals& intervals, double start, double length, double height) {
  std::vector<double> values;
  for (const double t : intervals.centers()) {
    values.push_back(0.6 + (height - 0.6) * std::clamp((t - start) / length, 0.0, 1.0));
  }
  return values;
}

constexpr RiseWindows kWindows{{5.0 - 1e-9, 5.65}, {5.65, 7.05}};

TEST(SecondRise, OfARampIsAtNineTenthsOfIt) {
  const Intervals intervals(range(2.0, 0.1, 51));
  const auto rise = second_rise(intervals, ramp(intervals, 6.2, 0.4, 1.0), kWindows);
  ASSERT_TRUE(rise);
  EXPECT_NEAR(rise->base, 0.6, 1e-12);
  EXPECT_NEAR(rise->height, 1.0, 1e-12);
  EXPECT_NEAR(rise->time, 6.2 + 0.9 * 0.4, 1e-9);
}

TEST(SecondRise, IsTheFirstCrestAndNotALaterSpike) {
  const Intervals intervals(range(2.0, 0.1, 51));
  auto values = ramp(intervals, 6.0, 0.2, 1.0);
  values.back() = 1.2;  // T = 7.0, long after the crest, half way mark 0.9
  const auto rise = second_rise(intervals, values, kWindows);
  ASSERT_TRUE(rise);
  EXPECT_NEAR(rise->height, 1.0, 1e-12);
  EXPECT_NEAR(rise->time, 6.18, 1e-9);
}

TEST(SecondRise, IsAbsentFromALevelSeriesAndFromARunThatEndsBefore) {
  const Intervals intervals(range(2.0, 0.1, 51));
  EXPECT_FALSE(second_rise(intervals, std::vector<double>(intervals.size(), 0.6), kWindows));
  auto values = ramp(intervals, 6.2, 0.4, 1.0);
  values[48] = kNan;
  EXPECT_FALSE(second_rise(intervals, values, kWindows));
}

}  // namespace
}  // namespace sluice

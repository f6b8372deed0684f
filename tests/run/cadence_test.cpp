#include "engine/run/cadence.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sluice {
namespace {

TEST(CheckpointInterval, IsYoungsBetweenTheLimits) {
  const double cost = 0.05;
  EXPECT_DOUBLE_EQ(checkpoint_interval(cost), std::sqrt(2.0 * cost * 3600.0) - cost);
}

TEST(CheckpointInterval, IsAtLeastTwoSecondsAndAtMostAMinute) {
  EXPECT_EQ(checkpoint_interval(0.0), 2.0);
  EXPECT_EQ(checkpoint_interval(1e-5), 2.0);
  EXPECT_EQ(checkpoint_interval(2.0), 60.0);
}

TEST(CheckpointInterval, SpendsAtMostAFivePercentShareWhateverTheCost) {
  for (double cost = 1e-4; cost < 1e4; cost *= 1.7) {
    EXPECT_LE(cost / checkpoint_interval(cost), 0.05 * (1 + 1e-12)) << cost;
  }
}

TEST(SeriesInterval, IsASecondOrTwoHundredTimesTheCost) {
  EXPECT_EQ(series_interval(0.001), 1.0);
  EXPECT_DOUBLE_EQ(series_interval(0.2), 40.0);
}

TEST(Backoff, DoublesTheWaitUpToEightSeconds) {
  Backoff backoff(1e9);
  double now = 0.0;
  for (const double wait : {0.5, 1.0, 2.0, 4.0, 8.0, 8.0}) {
    backoff.failed(now);
    EXPECT_DOUBLE_EQ(backoff.next_try() - now, wait);
    EXPECT_TRUE(backoff.waiting(now));
    now = backoff.next_try();
    EXPECT_FALSE(backoff.waiting(now));
  }
}

TEST(Backoff, IsExhaustedWhenTheNextTryWouldComeAfterThePatience) {
  Backoff backoff(1.6);
  EXPECT_FALSE(backoff.exhausted());
  backoff.failed(0.0);
  EXPECT_FALSE(backoff.exhausted());
  backoff.failed(0.5);
  EXPECT_FALSE(backoff.exhausted());
  backoff.failed(1.5);
  EXPECT_TRUE(backoff.exhausted());
}

TEST(Backoff, ASuccessStartsItAnew) {
  Backoff backoff(1.0);
  backoff.failed(0.0);
  backoff.succeeded();
  EXPECT_FALSE(backoff.waiting(0.0));
  backoff.failed(100.0);
  EXPECT_FALSE(backoff.exhausted());
}

TEST(Backoff, WithoutPatienceTheFirstFailureIsTheLast) {
  Backoff backoff(0.0);
  backoff.failed(5.0);
  EXPECT_TRUE(backoff.exhausted());
}

}  // namespace
}  // namespace sluice

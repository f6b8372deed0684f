#include "engine/run/schedule.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

namespace sluice {
namespace {

/// Times at which something with this interval happens when a run passes through `times`.
std::vector<double> happenings(const std::vector<double>& times, double interval) {
  std::vector<double> happened;
  std::uint64_t next = 0;
  for (const double time : times) {
    if (!is_due(time, interval, next)) continue;
    next = next_index_after(time, interval, next);
    happened.push_back(time);
  }
  return happened;
}

TEST(Schedule, HappensAtTheFirstStepAtOrAfterEachMultiple) {
  const std::vector<double> times{0.0, 0.3, 0.9, 1.0, 1.2, 1.9, 2.1, 2.9, 3.0};
  EXPECT_EQ(happenings(times, 1.0), (std::vector<double>{0.0, 1.0, 2.1, 3.0}));
}

TEST(Schedule, AStepAcrossSeveralMultiplesCountsOnce) {
  EXPECT_EQ(happenings({0.0, 5.5, 5.6, 6.0}, 1.0), (std::vector<double>{0.0, 5.5, 6.0}));
}

TEST(Schedule, AnIntervalOfZeroIsEveryStep) {
  const std::vector<double> times{0.0, 0.1, 0.2, 0.3};
  EXPECT_EQ(happenings(times, 0.0), times);
}

TEST(Schedule, ForAnyStepsTheNextMultipleLiesAfterTheTimeAndTheOneBeforeDoesNot) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const double interval = std::exp(std::uniform_real_distribution<double>(-9, 1)(random));
    std::uint64_t next = 0;
    double time = 0.0;
    for (int step = 0; step < 200; ++step) {
      if (is_due(time, interval, next)) {
        next = next_index_after(time, interval, next);
        ASSERT_FALSE(is_due(time, interval, next));
        ASSERT_TRUE(is_due(time, interval, next - 1));
      }
      time += interval * std::uniform_real_distribution<double>(0.0, 2.5)(random);
    }
  }
}

TEST(Schedule, MultiplesHitExactlyAreNotMissedByRounding) {
  // k * 0.1 is inexact for most k: floor(k*0.1/0.1) may be k - 1.
  std::uint64_t next = 0;
  for (std::uint64_t k = 0; k < 100000; ++k) {
    const double time = static_cast<double>(k) * 0.1;
    ASSERT_TRUE(is_due(time, 0.1, next)) << k;
    next = next_index_after(time, 0.1, next);
    ASSERT_EQ(next, k + 1);
  }
}

TEST(Schedule, ATinyIntervalNeitherHangsNorOverflows) {
  const auto next = next_index_after(1.0, std::numeric_limits<double>::denorm_min(), 0);
  EXPECT_EQ(next, 9007199254740992U);
}

}  // namespace
}  // namespace sluice

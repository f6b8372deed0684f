#include "service/jobs/retention_clock.hpp"

#include <gtest/gtest.h>

#include "service/jobs/retention.hpp"
#include "tests/service/scheduler/scheduler_support.hpp"

namespace sluice::test {
namespace {

constexpr double kDay = 86400.0;
constexpr std::int64_t kDayMs = 86'400'000;
constexpr std::int64_t kNow = 20'000 * kDayMs;  // in 2024

TEST(RetentionClock, FollowsAWallClockThatIsRight) {
  RetentionClock clock(30 * kDay, kNow);
  EXPECT_EQ(clock.look(kNow + 1000, 5.0), kNow + 1000);
  EXPECT_EQ(clock.look(kNow + kDayMs / 2, 5.0 + kDay / 2), kNow + kDayMs / 2);
  EXPECT_FALSE(clock.new_leap());
}

TEST(RetentionClock, DoesNotBelieveALeapBeforeItHasLastedADay) {
  RetentionClock clock(30 * kDay, kNow);
  const std::int64_t ahead = 46 * kDayMs;
  EXPECT_EQ(clock.look(kNow + ahead, 0.0), kNow);
  ASSERT_TRUE(clock.new_leap());
  EXPECT_DOUBLE_EQ(*clock.new_leap(), 46 * kDay);
  EXPECT_EQ(clock.look(kNow + ahead + 600'000, 600.0), kNow + 600'000);
  EXPECT_FALSE(clock.new_leap());
  EXPECT_EQ(clock.look(kNow + ahead + kDayMs, kDay), kNow + ahead + kDayMs);
}

TEST(RetentionClock, ForgetsALeapThatIsTakenBackAndFollowsAClockThatIsSetBack) {
  RetentionClock clock(30 * kDay, 0);
  EXPECT_EQ(clock.look(kNow, 0.0), kNow);
  EXPECT_EQ(clock.look(kNow + 90 * kDayMs, 10.0), kNow + 10'000);
  EXPECT_EQ(clock.look(kNow + 20'000, 20.0), kNow + 20'000);
  EXPECT_EQ(clock.look(kNow - kDayMs, 30.0), kNow - kDayMs);
}

TEST(RetentionClock, IsKeptForTheNextService) {
  const DataFolder data;
  EXPECT_EQ(read_retention_time(data.path()), 0);
  write_retention_time(data.path(), kNow);
  EXPECT_EQ(read_retention_time(data.path()), kNow);
  write_file(data.path() / "retention.json", "rubbish");
  EXPECT_EQ(read_retention_time(data.path()), 0);
}

/// A service starts while the clock is 46 days ahead, and is started once more.
TEST(RetentionClock, ADeletionWaitsWhenTheServiceStartsWithAWrongClock) {
  const DataFolder data;
  JobStore store(data.path());
  const Job ended = add_job_in(store, JobState::completed);
  ServiceLimits limits = limits_for_scripts();
  limits.retention_days = 30.0;
  SchedulerSenses senses;
  senses.wall_ms = [] { return unix_time_ms() + 46 * kDayMs; };
  for (int start = 0; start < 2; ++start) {
    {
      Scheduler scheduler(store, data.path(), limits, {}, senses);
      wait_until("a look", [&] { return std::filesystem::exists(data.path() / "retention.json"); });
      scheduler.drain();
    }
    ASSERT_TRUE(store.find(ended.id));
    (void)add_job_in(store, JobState::completed);
  }
}

TEST(Retention, GoesByIdsWhereAJobEndedWhileTheClockWasBehind) {
  const DataFolder data;
  JobStore store(data.path());
  const Job ended = add_job_in(store, JobState::completed);  // its id is of now
  EXPECT_EQ(delete_old_jobs(store, data.path(), unix_time_ms() - kDayMs, 10), 0u);
  EXPECT_EQ(delete_old_jobs(store, data.path(), unix_time_ms() + kDayMs, 10), 1u);
  EXPECT_FALSE(store.find(ended.id));
}

}  // namespace
}  // namespace sluice::test

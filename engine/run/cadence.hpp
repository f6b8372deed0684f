#pragma once

namespace sluice {

/// Seconds between failures that the checkpoint interval is chosen for. An hour is pessimistic for
/// one machine and about right where jobs are evicted; the interval goes with its square root, so a
/// wrong guess by 10 costs a factor of 3.
inline constexpr double kMeanTimeBetweenFailures = 3600.0;

/// Seconds of work between two checkpoints that cost `cost` seconds each: sqrt(2CM) - C (Young
/// 1974), between max(2 s, 20 C) and 60 s: at most a minute is lost and at most 5 % of the time is
/// spent. Where the two collide (C above 3 s) the 5 % count.
[[nodiscard]] double checkpoint_interval(double cost);

/// Seconds between two publications of the series that cost `cost` seconds: a second, or more to
/// keep to half a percent of the time.
[[nodiscard]] double series_interval(double cost);

/// When to try again after a failed write: 0.5, 1, 2, ... 8 s, until `patience` seconds have passed
/// since the first failure. Takes the time as an argument; knows no clock.
class Backoff {
 public:
  explicit Backoff(double patience) : patience_(patience) {}

  /// Records a failure at `now` (s).
  void failed(double now);
  void succeeded() { failures_ = 0; }
  [[nodiscard]] bool waiting(double now) const { return failures_ > 0 && now < next_try_; }
  /// True when another try would come too late.
  [[nodiscard]] bool exhausted() const;
  [[nodiscard]] int failures() const { return failures_; }
  [[nodiscard]] double next_try() const { return next_try_; }

 private:
  double patience_;
  int failures_ = 0;
  double first_failure_ = 0.0;
  double next_try_ = 0.0;
};

}  // namespace sluice

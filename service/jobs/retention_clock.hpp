#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace sluice {

/// The time by which jobs are old: the wall clock as far as it can be believed. A clock that leaps
/// ahead, between two looks or while the service was off, would make every job old at once, and
/// what is deleted does not come back. So this time goes on at the pace of a steady clock until the
/// wall clock has stood by its leap for a grace. For one thread.
class RetentionClock {
 public:
  /// `kept`: how long jobs are kept, s. A leap is more than a tenth of that, the grace as long as
  /// that, both a second at least and a day at most. `known_ms`: the newest time that is known from
  /// before, Unix time in ms; 0: none.
  RetentionClock(double kept, std::int64_t known_ms);

  /// The time now, Unix time in ms. `wall_ms`: what the wall clock says; `steady`: seconds of a
  /// clock that never steps.
  std::int64_t look(std::int64_t wall_ms, double steady);
  /// By how much the wall clock is ahead, s, when that is news: it has just leapt.
  [[nodiscard]] std::optional<double> new_leap() const { return new_leap_; }
  [[nodiscard]] double grace() const { return grace_; }

 private:
  double leap_;
  double grace_;
  std::int64_t now_ms_;
  double last_look_ = 0.0;
  bool looked_ = false;
  std::optional<double> leapt_at_;  ///< s of the steady clock
  std::optional<double> new_leap_;
};

/// The time that the last look of a service came to, DATA/retention.json; 0 where there is none.
[[nodiscard]] std::int64_t read_retention_time(const std::filesystem::path& data);
/// Keeps it for the next service. Throws StorageError.
void write_retention_time(const std::filesystem::path& data, std::int64_t now_ms);

}  // namespace sluice

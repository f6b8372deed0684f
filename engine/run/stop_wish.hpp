#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <vector>

namespace sluice {

/// The signals that ask this process to stop: SIGTERM, SIGINT and SIGHUP. SIGHUP is left out where
/// it is ignored already, as nohup has it: the process stays deaf to a terminal that goes away.
[[nodiscard]] std::vector<int> stop_signals();

/// Signals within this time of the first one are the same wish: a closed terminal, a session that
/// ends and timeout(1) each send two or more, and a parent passes its own on.
inline constexpr std::chrono::nanoseconds kSameWish = std::chrono::seconds(2);

/// A wish to stop, as the handler of a signal takes it. Everything here may be called from one.
class StopWish {
 public:
  enum class Kind { first, same, at_once };
  /// Takes a signal that came at `now` of the monotonic clock.
  Kind take(std::chrono::nanoseconds now);
  /// The same for one that comes now.
  Kind take();
  [[nodiscard]] bool asked() const { return first_.load() != kNever; }
  void forget() { first_.store(kNever); }

 private:
  static constexpr std::int64_t kNever = INT64_MIN;
  std::atomic<std::int64_t> first_{kNever};  ///< when the first one came, ns
  static_assert(std::atomic<std::int64_t>::is_always_lock_free);
};

}  // namespace sluice

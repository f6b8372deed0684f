#pragma once

#include <sys/types.h>

namespace sluice {

/// What the system says of a process and the cores.
struct CoreUse {
  double core_seconds = 0.0;  ///< that its threads have had, together
  bool runnable = false;      ///< one of them runs or stands in line for a core
};

/// Reads /proc/PID/task/*/stat. Of a process that is gone: nothing used, not runnable.
[[nodiscard]] CoreUse core_use(pid_t process);

/// How long a process has got no further although it could have. Time in which it wants to run
/// counts by what it gets of the cores: on a machine that is full of others' work it may wait for
/// long and is not stuck. All other time counts whole. Times are seconds of the caller's clock.
class StallClock {
 public:
  explicit StallClock(double now) : looked_(now) {}

  /// It has got further.
  void restart(double now) {
    seconds_ = 0.0;
    looked_ = now;
  }
  /// To be called about once a second; `use` is of `now`. Returns the seconds.
  double look(double now, const CoreUse& use);

 private:
  double seconds_ = 0.0;
  double looked_;
  double core_seconds_ = 0.0;
};

}  // namespace sluice

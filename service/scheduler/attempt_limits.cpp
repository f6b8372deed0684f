#include "service/scheduler/attempt_limits.hpp"

#include "service/jobs/disk_guard.hpp"

namespace sluice {
namespace {

constexpr double kDiskLook = 10.0;  // s between looks at how much a job takes

void watch_disk(Attempt& attempt, const ServiceLimits& limits, double now) {
  if (limits.disk_per_job == 0 || !attempt.disk_look_due(now, kDiskLook)) return;
  if (used_disk(attempt.paths().root()) > limits.disk_per_job) {
    attempt.stop(StopCause::disk_limit, now);
  }
}

}  // namespace

void hold_to_limits(Attempt& attempt, const ServiceLimits& limits, const SchedulerSenses& senses) {
  const double now = senses.clock();
  if (attempt.stop_cause() != StopCause::none) {
    if (attempt.stopping_for(now) > limits.stop_seconds) attempt.kill(attempt.stop_cause());
    return;
  }
  const CoreUse use = senses.core_use(attempt.worker().pid());
  if (attempt.stalled_for(now, use) > limits.stalled_seconds) {
    return attempt.kill(StopCause::stalled);
  }
  const double longest = limits.wall_seconds_per_attempt;
  if (longest > 0.0 && attempt.age(now) > longest) attempt.stop(StopCause::wall_limit, now);
  watch_disk(attempt, limits, now);
}

}  // namespace sluice

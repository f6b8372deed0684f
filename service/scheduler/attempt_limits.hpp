#pragma once

#include "service/jobs/limits.hpp"
#include "service/scheduler/attempt.hpp"
#include "service/scheduler/scheduler_senses.hpp"

namespace sluice {

/// Stops or kills the attempt when it has run or stalled too long, takes too much of the disk, or
/// does not obey a stop. To be called about once a second, with the clock that the attempt was made
/// with.
void hold_to_limits(Attempt& attempt, const ServiceLimits& limits, const SchedulerSenses& senses);

}  // namespace sluice

#pragma once

#include <filesystem>

#include "service/jobs/job.hpp"
#include "service/scheduler/scheduler.hpp"
#include "service/worker/worker_process.hpp"

namespace sluice {

/// How a worker for this job in `folder` is started within the limits. `program` may be empty:
/// this one.
[[nodiscard]] WorkerCommand worker_command(const std::filesystem::path& program,
                                           const std::filesystem::path& folder, const Job& job,
                                           const ServiceLimits& limits);

}  // namespace sluice

#pragma once

#include <filesystem>

#include "engine/execute/process_command.hpp"
#include "service/jobs/job.hpp"
#include "service/jobs/limits.hpp"

namespace sluice {

/// How a worker for this job in `folder` is started within the limits. `program` may be empty:
/// this one. Its input is empty, its output goes into pipes, and it has nothing else of this
/// process's. SIGUSR1 is ignored until it takes it, and it gets SIGTERM when the thread that starts
/// it ends.
[[nodiscard]] ProcessCommand worker_command(const std::filesystem::path& program,
                                            const std::filesystem::path& folder, const Job& job,
                                            const ServiceLimits& limits);

}  // namespace sluice

#pragma once

#include <string>

#include "engine/store/files/job_folder.hpp"

namespace sluice {

/// Whether some process runs the job in this folder. A folder that cannot be locked for another
/// reason is not in use.
[[nodiscard]] bool is_in_use(const JobPaths& paths);

/// Kills the process that runs the job, when it is the worker of the attempt `token`: a worker that
/// outlived its service and does not obey. False when it is someone else's.
bool kill_orphan(const JobPaths& paths, const std::string& token);

}  // namespace sluice

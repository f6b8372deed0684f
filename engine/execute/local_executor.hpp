#pragma once

#include "engine/execute/executor.hpp"

namespace sluice {

/// Starts children of this process by fork and exec. What a command asks for and the system
/// refuses is a ProcessStartError, but for its priority. Where the kernel has no process
/// descriptors, end_descriptor() is below 0; SIGCHLD tells of the end too. Thread-safe; its
/// processes get `at_parents_end` when the thread that started them ends.
[[nodiscard]] Executor& local_executor();

}  // namespace sluice

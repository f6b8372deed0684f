#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "service/jobs/disk_guard.hpp"
#include "service/jobs/job_ids.hpp"
#include "service/worker/core_use.hpp"

namespace sluice {

/// What the scheduler perceives of the machine. Tests put their own in its place; several threads
/// call these at once.
struct SchedulerSenses {
  /// Seconds of a clock that never steps back.
  std::function<double()> clock = [] {
    using Seconds = std::chrono::duration<double>;
    return Seconds(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  /// The wall clock, Unix time in ms, which may be wrong and may leap.
  std::function<std::int64_t()> wall_ms = unix_time_ms;
  /// Bytes that may still be written on the disk of a folder.
  std::function<std::uint64_t(const std::filesystem::path&)> free_disk = sluice::free_disk;
  /// What a worker has had of the cores, and whether it wants more.
  std::function<CoreUse(pid_t)> core_use = sluice::core_use;
};

}  // namespace sluice

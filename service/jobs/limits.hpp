#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/execute/process_command.hpp"

namespace sluice {

/// Limits of the service; all can be set on the command line of `sluice serve`.
struct ServiceLimits {
  int cores = 0;  ///< threads of all workers together; 0: the machine's
  std::size_t queued_jobs = 10000;
  std::size_t runs_per_study = 100;
  std::uint64_t particles_per_job = 5'000'000;
  std::uint64_t memory_per_job = 0;          ///< bytes; 0: three quarters of the machine's
  std::uint64_t disk_per_job = 20ULL << 30;  ///< bytes; 0: none
  double wall_seconds_per_attempt = 0.0;     ///< 0: none
  double stalled_seconds = 60.0;             ///< without progress (StallClock): the worker is ended
  double stop_seconds = 45.0;  ///< a worker that was asked to stop is killed after that
  int crash_limit = 3;
  std::uint64_t disk_reserve =
      512ULL << 20;  ///< bytes left free on the data folder's disk: jobs pause before that
  double retention_days = 0.0;                  ///< ended jobs are deleted after that; 0: kept
  Confinement confinement = Confinement::full;  ///< of the workers
};

/// Bytes of memory that one job may take: the limit, or three quarters of the machine's.
[[nodiscard]] std::uint64_t memory_limit(const ServiceLimits& limits);
/// Threads that one job may take: the limit, or the machine's cores.
[[nodiscard]] int thread_limit(const ServiceLimits& limits);

}  // namespace sluice

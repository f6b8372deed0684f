#include "service/jobs/limits.hpp"

#include <unistd.h>

#include <algorithm>
#include <thread>

namespace sluice {

std::uint64_t memory_limit(const ServiceLimits& limits) {
  if (limits.memory_per_job > 0) return limits.memory_per_job;
  const auto pages = static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PHYS_PAGES)));
  const auto page = static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PAGESIZE)));
  return pages * page / 4 * 3;
}

int thread_limit(const ServiceLimits& limits) {
  if (limits.cores > 0) return limits.cores;
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace sluice

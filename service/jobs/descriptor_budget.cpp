#include "service/jobs/descriptor_budget.hpp"

#include <sys/resource.h>

#include <algorithm>

namespace sluice {
namespace {

/// The data base, locks, logs, what starting a worker takes, and some to spare.
constexpr std::uint64_t kReserved = 40;
constexpr std::uint64_t kPerWorker = 4;  // its end, its two pipes, its log
constexpr std::uint64_t kFewest = 6;     // connections
constexpr std::uint64_t kMost = 1 << 20;

/// Two of three are connections, one is a file that is sent.
constexpr std::uint64_t kPart = 2;
constexpr std::uint64_t kWhole = 3;

std::uint64_t taken_by(int workers) {
  return kReserved + kPerWorker * static_cast<std::uint64_t>(std::max(workers, 1));
}

}  // namespace

std::uint64_t raise_descriptor_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return 0;
  const rlimit raised{std::min<rlim_t>(limit.rlim_max, kMost), limit.rlim_max};
  if (raised.rlim_cur > limit.rlim_cur && ::setrlimit(RLIMIT_NOFILE, &raised) == 0) limit = raised;
  return limit.rlim_cur;
}

int connections_within(std::uint64_t limit, int workers) {
  if (limit < least_descriptor_limit(workers)) return 0;
  return static_cast<int>(std::min((limit - taken_by(workers)) * kPart / kWhole, kMost));
}

std::uint64_t least_descriptor_limit(int workers) {
  return taken_by(workers) + kFewest * kWhole / kPart;
}

}  // namespace sluice

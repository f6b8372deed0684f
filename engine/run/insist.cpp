#include "engine/run/insist.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include "engine/run/cadence.hpp"
#include "engine/run/stopwatch.hpp"

namespace sluice {
namespace {

/// Between looks at whether there is a hurry, s. A signal wakes only one thread of many.
constexpr double kLook = 0.05;
/// Even in a hurry, s: what passes at all may pass in that time.
constexpr double kShortestWait = 0.5;

/// Whether it waited until `next` on the clock, rather than being hurried.
bool waited_until(double next, const Stopwatch& clock, const std::function<bool()>& hurried) {
  const double soonest = std::min(next, clock.seconds() + kShortestWait);
  for (double now = clock.seconds(); now < next; now = clock.seconds()) {
    const bool hurry = hurried && hurried();
    if (hurry && now >= soonest) return false;
    const double left = (hurry ? soonest : next) - now;
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left, kLook)));
  }
  return !hurried || !hurried();
}

}  // namespace

bool may_pass(StorageFault fault) {
  return fault == StorageFault::disk_full || fault == StorageFault::io ||
         fault == StorageFault::unwritable;
}

void insist(double patience, const std::function<void()>& write,
            const std::function<void(const StorageError&, double)>& tell,
            const std::function<bool()>& hurried) {
  const Stopwatch clock;
  Backoff backoff(patience);
  bool last = false;
  for (;;) {
    try {
      return storing(write);
    } catch (const StorageError& error) {
      const double now = clock.seconds();
      backoff.failed(now);
      if (last || backoff.exhausted() || !may_pass(error.fault())) throw;
      tell(error, backoff.next_try() - now);
      last = !waited_until(backoff.next_try(), clock, hurried);
    }
  }
}

}  // namespace sluice

#include "engine/run/insist.hpp"

#include <chrono>
#include <thread>

#include "engine/run/cadence.hpp"
#include "engine/run/stopwatch.hpp"

namespace sluice {
namespace {

bool may_pass(StorageFault fault) {
  return fault == StorageFault::disk_full || fault == StorageFault::io ||
         fault == StorageFault::unwritable;
}

}  // namespace

void insist(double patience, const std::function<void()>& write,
            const std::function<void(const StorageError&, double)>& tell) {
  const Stopwatch clock;
  Backoff backoff(patience);
  for (;;) {
    try {
      return storing(write);
    } catch (const StorageError& error) {
      const double now = clock.seconds();
      backoff.failed(now);
      if (backoff.exhausted() || !may_pass(error.fault())) throw;
      tell(error, backoff.next_try() - now);
      std::this_thread::sleep_for(std::chrono::duration<double>(backoff.next_try() - now));
    }
  }
}

}  // namespace sluice

#pragma once

#include <chrono>

namespace sluice {

/// Seconds of the clock that all of the scheduler goes by; it never steps back.
[[nodiscard]] inline double scheduler_clock() {
  using Seconds = std::chrono::duration<double>;
  return Seconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace sluice

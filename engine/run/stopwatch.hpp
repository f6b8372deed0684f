#pragma once

#include <chrono>

namespace sluice {

/// Seconds of wall time since it was made. For cost and cadence only: nothing that a run computes
/// depends on it.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace sluice

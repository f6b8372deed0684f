#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>

namespace sluice {

/// Places for requests that hold a thread or memory for long. Thread-safe. Must outlive what it
/// gave out.
class Slots {
 public:
  explicit Slots(std::int64_t count) : count_(count), free_(count) {}

  /// `wanted` places (all, where there are not so many), held for the life of the pointer and its
  /// copies; null when too few are free.
  [[nodiscard]] std::shared_ptr<void> try_take(std::int64_t wanted = 1) {
    wanted = std::min(wanted, count_);
    if (free_.fetch_sub(wanted) < wanted) {
      free_.fetch_add(wanted);
      return nullptr;
    }
    return {this, [wanted](void* slots) { static_cast<Slots*>(slots)->free_.fetch_add(wanted); }};
  }

 private:
  const std::int64_t count_;
  std::atomic<std::int64_t> free_;
};

}  // namespace sluice

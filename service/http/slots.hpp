#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>

namespace sluice {

/// Places for requests that hold a thread or memory for long. Thread-safe. Must outlive what it
/// gave out.
class Slots {
 public:
  explicit Slots(std::int64_t count) : count_(count), free_(count) {}

  /// `wanted` places (all, where there are not so many), held for the life of the pointer and its
  /// copies; null when too few are free within `patience` s.
  [[nodiscard]] std::shared_ptr<void> try_take(std::int64_t wanted = 1, double patience = 0.0) {
    wanted = std::min(wanted, count_);
    std::unique_lock lock(mutex_);
    const auto enough = [&] { return free_ >= wanted; };
    if (!freed_.wait_for(lock, std::chrono::duration<double>(patience), enough)) return nullptr;
    free_ -= wanted;
    return {this, [wanted](void* slots) { static_cast<Slots*>(slots)->give_back(wanted); }};
  }

 private:
  void give_back(std::int64_t count) {
    const std::scoped_lock lock(mutex_);
    free_ += count;
    freed_.notify_all();
  }

  const std::int64_t count_;
  std::mutex mutex_;
  std::condition_variable freed_;
  std::int64_t free_;
};

}  // namespace sluice

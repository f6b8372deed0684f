#pragma once

#include <atomic>
#include <memory>

namespace sluice {

/// A number of places for requests that hold a thread for long. Thread-safe. Must outlive what it
/// gave out.
class Slots {
 public:
  explicit Slots(int count) : free_(count) {}

  /// A place, held for the life of the pointer and its copies; null when all are taken.
  [[nodiscard]] std::shared_ptr<void> try_take() {
    if (free_.fetch_sub(1) <= 0) {
      free_.fetch_add(1);
      return nullptr;
    }
    return {this, [](void* slots) { static_cast<Slots*>(slots)->free_.fetch_add(1); }};
  }

 private:
  std::atomic<int> free_;
};

}  // namespace sluice

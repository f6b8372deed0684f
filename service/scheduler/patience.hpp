#pragma once

#include <string>

namespace sluice {

/// A job that needs many cores would wait for ever behind small ones that slip past it: after a
/// minute cores are kept for it. Times are seconds of the caller's clock.
class Patience {
 public:
  /// s that a job may be passed over by smaller ones behind it.
  static constexpr double kSeconds = 60.0;

  /// The queue's first job, `id`, needs more cores than are free. True when it has been so for
  /// longer than kSeconds, seen without a break.
  [[nodiscard]] bool is_over(const std::string& id, double now) {
    if (id != id_) {
      id_ = id;
      since_ = now;
    }
    return now - since_ > kSeconds;
  }
  /// The queue's first job fits, or there is none.
  void forget() { id_.clear(); }

 private:
  std::string id_;
  double since_ = 0.0;
};

}  // namespace sluice

#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "service/jobs/job_store.hpp"

namespace sluice {

/// The queue in the order of claims, as it was at most a second ago: an answer to "how many are
/// before me" that costs nothing when it is asked often. Thread-safe.
class QueueView {
 public:
  explicit QueueView(const JobStore& store) : store_(store) {}

  struct Entry {
    int priority = 0;
    int threads = 1;
    std::string id;
  };
  /// Queued jobs that are claimed before this one.
  [[nodiscard]] std::size_t ahead_of(const Job& job, double now) const;
  /// The first that is not in `except` and needs at most `threads`.
  [[nodiscard]] std::optional<Entry> first(int threads, const std::vector<std::string>& except,
                                           double now) const;

 private:
  void refresh(double now) const;

  const JobStore& store_;
  mutable std::mutex mutex_;
  mutable std::vector<Entry> entries_;
  mutable std::optional<double> read_at_;  ///< s of the caller's clock
};

}  // namespace sluice

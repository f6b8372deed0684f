#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "service/jobs/job_store.hpp"

namespace sluice {

/// Counts what the service did since it started and writes it as Prometheus text (version 0.0.4).
/// Thread-safe.
class Metrics {
 public:
  /// Events up to number `last_event` are not counted.
  explicit Metrics(std::int64_t last_event) : last_event_(last_event) {}

  void count(std::string_view method, int status, double seconds);
  /// Reads the new events and the running jobs' progress from the store.
  [[nodiscard]] std::string text(const JobStore& store);

 private:
  /// Upper bounds of the latency histogram, s.
  static constexpr std::array kBounds{0.001, 0.005, 0.01, 0.05, 0.1, 0.5, 1.0, 5.0, 30.0};

  void count_events(const JobStore& store);

  std::mutex mutex_;
  std::map<std::pair<std::string, int>, std::uint64_t> requests_;
  std::array<std::uint64_t, kBounds.size() + 1> latencies_{};
  double latency_sum_ = 0.0;
  std::map<std::string, std::uint64_t> events_;
  std::int64_t last_event_;
};

}  // namespace sluice

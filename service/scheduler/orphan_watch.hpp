#pragma once

#include <filesystem>
#include <functional>
#include <list>
#include <utility>

#include "service/jobs/job.hpp"

namespace sluice {

/// Jobs that are marked running and have no worker of this service. For one thread; times are
/// seconds of the caller's clock.
class OrphanWatch {
 public:
  /// `data` is the data folder. A worker of the last service that has not stopped after
  /// `stop_seconds` is killed.
  OrphanWatch(std::filesystem::path data, double stop_seconds)
      : data_(std::move(data)), stop_seconds_(stop_seconds) {}

  void add(Job job, double now) { orphans_.push_back({std::move(job), now}); }
  /// Hands out those whose folder nobody uses any more. One whose `conclude` throws stays here and
  /// is handed out again.
  void look(double now, const std::function<void(const Job&)>& conclude);

  [[nodiscard]] bool empty() const { return orphans_.empty(); }
  /// Cores that their workers may still take.
  [[nodiscard]] int threads() const;

 private:
  struct Orphan {
    Job job;
    double since = 0.0;
    bool killed = false;
    bool complained = false;
  };
  [[nodiscard]] bool concluded(Orphan& orphan,
                               const std::function<void(const Job&)>& conclude) const;
  void kill_when_late(Orphan& orphan, double now) const;

  std::filesystem::path data_;
  double stop_seconds_;
  std::list<Orphan> orphans_;
};

}  // namespace sluice

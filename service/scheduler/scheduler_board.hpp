#pragma once

#include <sys/types.h>

#include <condition_variable>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "engine/store/disk/file_system.hpp"
#include "service/scheduler/back_offs.hpp"

namespace sluice {

/// What the scheduler's thread lets others know.
struct SchedulerStatus {
  bool disk_low = false;
  int cores = 0;
  int free_threads = 0;
  BackOffs back_offs;
  std::map<std::string, pid_t> workers;  ///< of the attempts that run, by job
};

/// Where the scheduler's thread and all others meet: requests go in, the status comes out.
/// Thread-safe.
class SchedulerBoard {
 public:
  /// Throws std::system_error when the system has no descriptor left.
  SchedulerBoard();

  /// Becomes readable when someone pokes.
  [[nodiscard]] int bell() const { return bell_.get(); }
  void poke();
  /// Silences the bell.
  void hear();

  void ask_for_checkpoint(const std::string& id);
  [[nodiscard]] std::set<std::string> take_checkpoint_requests();

  void ask_to_drain();
  [[nodiscard]] bool draining() const;
  void note_drained();
  void wait_until_drained() const;

  void publish(SchedulerStatus status);
  [[nodiscard]] SchedulerStatus status() const;

 private:
  FileDescriptor bell_;
  mutable std::mutex mutex_;
  mutable std::condition_variable drained_changed_;
  std::set<std::string> checkpoint_requests_;
  SchedulerStatus status_;
  bool draining_ = false;
  bool drained_ = false;
};

}  // namespace sluice

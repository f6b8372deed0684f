#pragma once

#include <condition_variable>
#include <mutex>
#include <set>
#include <string>

namespace sluice {

/// One at a time per job: whoever changes both a job's row and its folder holds the job meanwhile.
/// For any thread; nobody holds two jobs at once.
class JobLocks {
 public:
  class Guard {
   public:
    Guard(JobLocks& locks, std::string id);
    Guard(const Guard&) = delete;
    Guard& operator=(const Guard&) = delete;
    ~Guard();

   private:
    JobLocks& locks_;
    std::string id_;
  };

  /// Waits until nobody else holds the job.
  [[nodiscard]] Guard hold(const std::string& id) { return {*this, id}; }

 private:
  std::mutex mutex_;  ///< guards held_
  std::condition_variable freed_;
  std::set<std::string> held_;
};

}  // namespace sluice

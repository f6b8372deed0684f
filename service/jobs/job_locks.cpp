#include "service/jobs/job_locks.hpp"

#include <utility>

namespace sluice {

JobLocks::Guard::Guard(JobLocks& locks, std::string id) : locks_(locks), id_(std::move(id)) {
  std::unique_lock lock(locks_.mutex_);
  locks_.freed_.wait(lock, [this] { return !locks_.held_.contains(id_); });
  locks_.held_.insert(id_);
}

JobLocks::Guard::~Guard() {
  {
    const std::scoped_lock lock(locks_.mutex_);
    locks_.held_.erase(id_);
  }
  locks_.freed_.notify_all();
}

}  // namespace sluice

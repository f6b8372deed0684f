#include "service/scheduler/scheduler_board.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <system_error>

namespace sluice {

SchedulerBoard::SchedulerBoard() : bell_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (bell_.get() < 0) {
    throw std::system_error(errno, std::generic_category(), "cannot make an event descriptor");
  }
}

void SchedulerBoard::poke() {
  const std::uint64_t one = 1;
  static_cast<void>(::write(bell_.get(), &one, sizeof one) == sizeof one);
}

void SchedulerBoard::hear() {
  std::uint64_t count = 0;
  static_cast<void>(::read(bell_.get(), &count, sizeof count) == sizeof count);
}

void SchedulerBoard::ask_for_checkpoint(const std::string& id) {
  {
    const std::lock_guard lock(mutex_);
    checkpoint_requests_.insert(id);
  }
  poke();
}

std::set<std::string> SchedulerBoard::take_checkpoint_requests() {
  const std::lock_guard lock(mutex_);
  return std::exchange(checkpoint_requests_, {});
}

void SchedulerBoard::ask_to_drain() {
  {
    const std::lock_guard lock(mutex_);
    draining_ = true;
  }
  poke();
}

bool SchedulerBoard::draining() const {
  const std::lock_guard lock(mutex_);
  return draining_;
}

void SchedulerBoard::note_drained() {
  const std::lock_guard lock(mutex_);
  drained_ = true;
  drained_changed_.notify_all();
}

void SchedulerBoard::wait_until_drained() const {
  std::unique_lock lock(mutex_);
  drained_changed_.wait(lock, [this] { return drained_; });
}

void SchedulerBoard::publish(SchedulerStatus status) {
  const std::lock_guard lock(mutex_);
  status_ = std::move(status);
}

SchedulerStatus SchedulerBoard::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

}  // namespace sluice

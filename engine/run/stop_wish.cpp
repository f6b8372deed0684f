#include "engine/run/stop_wish.hpp"

#include <csignal>
#include <ctime>

namespace sluice {
namespace {

bool is_ignored(int signal_number) {
  struct sigaction present {};
  return ::sigaction(signal_number, nullptr, &present) == 0 && present.sa_handler == SIG_IGN;
}

/// std::chrono does not promise that a handler may read its clocks; POSIX does for this one.
std::chrono::nanoseconds monotonic_now() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

}  // namespace

std::vector<int> stop_signals() {
  std::vector<int> numbers{SIGTERM, SIGINT};
  if (!is_ignored(SIGHUP)) numbers.push_back(SIGHUP);
  return numbers;
}

StopWish::Kind StopWish::take(std::chrono::nanoseconds now) {
  std::int64_t first = kNever;
  if (first_.compare_exchange_strong(first, now.count())) return Kind::first;
  return now.count() - first < kSameWish.count() ? Kind::same : Kind::at_once;
}

StopWish::Kind StopWish::take() { return take(monotonic_now()); }

}  // namespace sluice

#include "cli/stop_signals.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include "engine/run/stop_wish.hpp"

namespace sluice {
namespace {

/// The ends of a pipe: a handler may only write to one.
std::array<int, 2> pipe_ends{-1, -1};
StopWish stop_wish;

void take(int signal) {
  const int error = errno;
  if (stop_wish.take() == StopWish::Kind::at_once) ::_exit(128 + signal);
  [[maybe_unused]] const auto written = ::write(pipe_ends[1], "", 1);
  errno = error;
}

void set_action(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
}

}  // namespace

StopSignals::StopSignals() {
  if (::pipe2(pipe_ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) {
    throw std::runtime_error(fmt::format("cannot wait for signals: {}", std::strerror(errno)));
  }
  stop_wish.forget();
  signals_ = stop_signals();
  for (const int signal : signals_) set_action(signal, &take);
  set_action(SIGPIPE, SIG_IGN);
}

StopSignals::~StopSignals() {
  for (const int signal : signals_) set_action(signal, SIG_DFL);
  for (const int end : pipe_ends) ::close(end);
}

void StopSignals::wait() const {
  pollfd end{pipe_ends[0], POLLIN, 0};
  while (::poll(&end, 1, -1) < 0 && errno == EINTR) {
  }
}

}  // namespace sluice

#include "cli/run_pool.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <string>

#include "engine/run/stop_wish.hpp"
#include "engine/store/disk/file_system.hpp"

namespace sluice {
namespace {

int exit_code_by(const ProcessEnd& end) {
  return end.exit_code >= 0 ? end.exit_code : 128 + end.signal;
}

}  // namespace

RunPool::RunPool(Executor& executor) : executor_(executor) {
  // A reader of what is said who went away ends no run.
  std::signal(SIGPIPE, SIG_IGN);
  ::sigemptyset(&watched_);
  for (const int number : stop_signals()) ::sigaddset(&watched_, number);
  for (const int number : {SIGTSTP, SIGCHLD}) ::sigaddset(&watched_, number);
  ::sigprocmask(SIG_BLOCK, &watched_, &before_);
}

RunPool::~RunPool() {
  stop_all();
  while (!runs_.empty()) {
    if (!reap()) ::sigwaitinfo(&watched_, nullptr);
  }
  // A wish that came again meanwhile is fulfilled.
  const timespec no_time{};
  while (::sigtimedwait(&watched_, nullptr, &no_time) > 0) {
  }
  ::sigprocmask(SIG_SETMASK, &before_, nullptr);
}

void RunPool::start(std::size_t number, const std::filesystem::path& folder,
                    const std::filesystem::path& log, int threads) {
  const FileDescriptor output(
      ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0644));
  if (output.get() < 0) {
    throw std::runtime_error(
        fmt::format("cannot write {}: {}", log.string(), std::strerror(errno)));
  }
  ProcessCommand command;
  command.arguments = {"run",        folder.string(), "--threads", fmt::format("{}", threads),
                       "--progress", "none"};
  command.input = STDIN_FILENO;
  command.output = output.get();
  command.errors = output.get();
  command.signals.blocked = before_;
  command.signals.at_parents_end = SIGTERM;
  try {
    runs_.push_back({number, executor_.start(command)});
  } catch (const ProcessStartError& error) {
    throw std::runtime_error(fmt::format("cannot start a run: {}", error.code().message()));
  }
}

std::optional<RunPool::Ended> RunPool::reap() {
  for (auto run = runs_.begin(); run != runs_.end(); ++run) {
    const std::optional<ProcessEnd> end = run->process->reap();
    if (!end) continue;
    const Ended ended{run->number, exit_code_by(*end)};
    runs_.erase(run);
    return ended;
  }
  return std::nullopt;
}

std::optional<RunPool::Ended> RunPool::wait() {
  while (true) {
    if (const auto ended = reap()) return ended;
    const int signal = ::sigwaitinfo(&watched_, nullptr);
    if (signal == SIGTSTP) {
      rest();
    } else if (signal != SIGCHLD && signal > 0) {
      return std::nullopt;
    }
  }
}

void RunPool::stop_all() const { send(SIGTERM); }

void RunPool::send(int signal) const {
  for (const Run& run : runs_) run.process->send(signal);
}

void RunPool::rest() const {
  send(SIGSTOP);
  // By its own signal: the system knows when nobody could wake this process again.
  sigset_t suspend;
  ::sigemptyset(&suspend);
  ::sigaddset(&suspend, SIGTSTP);
  ::raise(SIGTSTP);
  ::sigprocmask(SIG_UNBLOCK, &suspend, nullptr);
  ::sigprocmask(SIG_BLOCK, &suspend, nullptr);
  send(SIGCONT);
}

}  // namespace sluice

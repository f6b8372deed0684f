#include "cli/run_pool.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
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

/// In the child, which has no other thread: nothing here allocates.
[[noreturn]] void become_run(char* const* arguments, int output, pid_t parent,
                             const sigset_t& mask) {
  // A group of its own: what a terminal sends to the study's is the study's to pass on.
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(128 + SIGTERM);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  ::sigprocmask(SIG_SETMASK, &mask, nullptr);
  ::execv("/proc/self/exe", arguments);
  ::_exit(127);
}

}  // namespace

RunPool::RunPool() {
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
  std::string words[] = {
      "sluice",     "run", folder.string(), "--threads", fmt::format("{}", threads),
      "--progress", "none"};
  char* arguments[std::size(words) + 1] = {};
  for (std::size_t k = 0; k < std::size(words); ++k) arguments[k] = words[k].data();
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) become_run(arguments, output.get(), parent, before_);
  if (child < 0) {
    throw std::runtime_error(fmt::format("cannot start a run: {}", std::strerror(errno)));
  }
  runs_.emplace(child, number);
}

std::optional<RunPool::Ended> RunPool::reap() {
  int status = 0;
  const pid_t child = ::waitpid(-1, &status, WNOHANG);
  const auto found = runs_.find(child);
  if (child <= 0 || found == runs_.end()) return std::nullopt;
  const Ended ended{found->second,
                    WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status)};
  runs_.erase(found);
  return ended;
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
  for (const auto& [child, number] : runs_) ::kill(child, signal);
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

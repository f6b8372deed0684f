#include "service/worker/child_launch.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>

#include "service/worker/time_slice.hpp"

namespace sluice {
namespace {

/// The service stays responsive while workers take all cores.
constexpr int kNiceness = 5;
constexpr int kHighestSignal = 64;

// Short of memory, the system should take a worker: it goes on from its checkpoint.
constexpr char kOomScore[] = "500";

[[noreturn]] void give_up(const ChildLaunch& launch, const char* action, int error) {
  const LaunchFailure failure{action, error};
  static_cast<void>(::write(launch.report, &failure, sizeof failure) == sizeof failure);
  ::_exit(127);
}

void require(int result, const ChildLaunch& launch, const char* action) {
  if (result < 0) give_up(launch, action, errno);
}

/// A parent that died before the request was made sends no signal.
void tie_to_parent(const ChildLaunch& launch) {
  require(::prctl(PR_SET_PDEATHSIG, SIGTERM), launch, "ask for a signal at the service's end");
  if (::getppid() != launch.parent) ::_exit(128 + SIGTERM);
}

/// A request for a checkpoint must not kill a worker that does not listen yet.
void reset_signals() {
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  for (int number = 1; number <= kHighestSignal; ++number) {
    static_cast<void>(::sigaction(number, &action, nullptr));
  }
  action.sa_handler = SIG_IGN;
  static_cast<void>(::sigaction(SIGUSR1, &action, nullptr));
}

void unblock_signals() {
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

void close_others_at_exec() {
  if (::syscall(SYS_close_range, 3U, ~0U, CLOSE_RANGE_CLOEXEC) == 0) return;
  const long count = std::clamp(::sysconf(_SC_OPEN_MAX), 1024L, 65536L);
  for (int number = 3; number < count; ++number) {
    static_cast<void>(::fcntl(number, F_SETFD, FD_CLOEXEC));
  }
}

void set_descriptors(const ChildLaunch& launch) {
  require(::dup2(launch.input, STDIN_FILENO), launch, "set its input");
  require(::dup2(launch.output, STDOUT_FILENO), launch, "set its output");
  require(::dup2(launch.errors, STDERR_FILENO), launch, "set its error output");
  if (launch.sandbox != nullptr) {
    require(::dup3(launch.program, launch.sandbox->program_descriptor(), O_CLOEXEC), launch,
            "give the program its descriptor");
  }
  close_others_at_exec();
}

template <class Resource>
void limit(const ChildLaunch& launch, Resource resource, rlim_t wanted) {
  rlimit present{};
  require(::getrlimit(resource, &present), launch, "read a limit");
  const rlim_t value = std::min(wanted, present.rlim_max);
  const rlimit limits{value, value};
  require(::setrlimit(resource, &limits), launch, "set a limit");
}

void set_limits(const ChildLaunch& launch) {
  limit(launch, RLIMIT_CORE, 0);
  limit(launch, RLIMIT_AS, launch.address_space);
  limit(launch, RLIMIT_FSIZE, launch.largest_file);
  const int descriptors =
      launch.sandbox == nullptr ? Sandbox::kDescriptorLimit : launch.sandbox->descriptor_limit();
  limit(launch, RLIMIT_NOFILE, static_cast<rlim_t>(descriptors));
}

/// All are wishes: a system that refuses them still runs the worker.
void step_back() {
  const int file = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file >= 0) {
    static_cast<void>(::write(file, kOomScore, sizeof kOomScore - 1) > 0);
    ::close(file);
  }
  static_cast<void>(::setpriority(PRIO_PROCESS, 0, kNiceness));
  ask_for_slices(0);  // not the service's short ones
}

void execute(const ChildLaunch& launch) {
  if (launch.sandbox == nullptr) {
    ::execve(launch.path, launch.arguments, launch.environment);
    return;
  }
  ::syscall(SYS_execveat, launch.sandbox->program_descriptor(), "", launch.arguments,
            launch.environment, AT_EMPTY_PATH);
}

}  // namespace

void become_worker(const ChildLaunch& launch) {
  static_cast<void>(::setpgid(0, 0));
  tie_to_parent(launch);
  reset_signals();
  set_descriptors(launch);
  require(::chdir(launch.folder), launch, "enter the job's folder");
  step_back();
  set_limits(launch);
  if (launch.sandbox != nullptr) {
    const int error = launch.sandbox->enter();
    if (error != 0) give_up(launch, "enter its sandbox", error);
  }
  unblock_signals();
  execute(launch);
  give_up(launch, "start the program", errno);
}

}  // namespace sluice

#include "engine/execute/child_launch.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <optional>

#include "engine/execute/time_slice.hpp"

namespace sluice {
namespace {

constexpr int kHighestSignal = 64;

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
  const int number = launch.command.signals.at_parents_end;
  if (number == 0) return;
  require(::prctl(PR_SET_PDEATHSIG, number), launch, "ask for a signal at its parent's end");
  if (::getppid() != launch.parent) ::_exit(128 + number);
}

void set_actions(const ProcessSignals& signals) {
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  if (signals.actions == ProcessSignals::Actions::usual) {
    for (int number = 1; number <= kHighestSignal; ++number) {
      static_cast<void>(::sigaction(number, &action, nullptr));
    }
  }
  action.sa_handler = SIG_IGN;
  for (const int number : signals.ignored) {
    static_cast<void>(::sigaction(number, &action, nullptr));
  }
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
  if (launch.command.others == ProcessCommand::Others::closed) close_others_at_exec();
}

void enter_folder(const ChildLaunch& launch) {
  const std::filesystem::path& folder = launch.command.folder;
  if (folder.empty()) return;
  require(::chdir(folder.c_str()), launch, "enter the job's folder");
}

/// All are wishes.
void set_priority(const ChildLaunch& launch) {
  const int file =
      launch.oom_score == nullptr ? -1 : ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file >= 0) {
    static_cast<void>(::write(file, launch.oom_score, std::strlen(launch.oom_score)) > 0);
    ::close(file);
  }
  const ProcessPriority& priority = launch.command.priority;
  if (priority.niceness) static_cast<void>(::setpriority(PRIO_PROCESS, 0, *priority.niceness));
  if (priority.slices_ns) ask_for_slices(*priority.slices_ns);
}

template <class Resource>
void limit(const ChildLaunch& launch, Resource resource, std::optional<std::uint64_t> wanted) {
  if (!wanted) return;
  rlimit present{};
  require(::getrlimit(resource, &present), launch, "read a limit");
  const rlim_t value = std::min<rlim_t>(*wanted, present.rlim_max);
  const rlimit limits{value, value};
  require(::setrlimit(resource, &limits), launch, "set a limit");
}

/// In a sandbox the program's own descriptor lies beyond the limit.
std::optional<std::uint64_t> descriptor_limit(const ChildLaunch& launch) {
  const std::optional<std::uint64_t> wanted = launch.command.limits.descriptors;
  if (launch.sandbox == nullptr) return wanted;
  const auto most = static_cast<std::uint64_t>(launch.sandbox->program_descriptor());
  return std::min(wanted.value_or(most), most);
}

void set_limits(const ChildLaunch& launch) {
  const ProcessLimits& limits = launch.command.limits;
  limit(launch, RLIMIT_CORE, limits.core_dump);
  limit(launch, RLIMIT_AS, limits.address_space);
  limit(launch, RLIMIT_FSIZE, limits.largest_file);
  limit(launch, RLIMIT_NOFILE, descriptor_limit(launch));
}

void enter_sandbox(const ChildLaunch& launch) {
  if (launch.sandbox == nullptr) return;
  const int error = launch.sandbox->enter();
  if (error != 0) give_up(launch, "enter its sandbox", error);
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

void become_process(const ChildLaunch& launch) {
  static_cast<void>(::setpgid(0, 0));
  tie_to_parent(launch);
  set_actions(launch.command.signals);
  set_descriptors(launch);
  enter_folder(launch);
  set_priority(launch);
  set_limits(launch);
  enter_sandbox(launch);
  ::sigprocmask(SIG_SETMASK, &launch.command.signals.blocked, nullptr);
  execute(launch);
  give_up(launch, "start the program", errno);
}

}  // namespace sluice

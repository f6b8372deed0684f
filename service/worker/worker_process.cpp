#include "service/worker/worker_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

#include "service/worker/child_launch.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

// Nothing else of the service's environment, which may hold secrets, reaches a worker.
constexpr std::array kPassedOn{
    "PATH",         "LANG",         "LC_ALL",        "TZ",         "LD_LIBRARY_PATH",
    "ASAN_OPTIONS", "TSAN_OPTIONS", "UBSAN_OPTIONS", "SLUICE_SIMD"};

[[noreturn]] void fail(std::string_view action, int error) {
  throw WorkerStartError(fmt::format("cannot start a worker: cannot {}: {}", action,
                                     std::generic_category().message(error)));
}

/// The same file under a number that the child does not put anything at.
FileDescriptor raised(const FileDescriptor& descriptor) {
  FileDescriptor copy(::fcntl(descriptor.get(), F_DUPFD_CLOEXEC, kFirstFreeDescriptor));
  if (copy.get() < 0) fail("copy a descriptor", errno);
  return copy;
}

FileDescriptor open_or_fail(const char* path, int flags) {
  const FileDescriptor descriptor(::open(path, flags | O_CLOEXEC));
  if (descriptor.get() < 0) fail(fmt::format("open {}", path), errno);
  return raised(descriptor);
}

struct Pipe {
  FileDescriptor reading{-1};
  FileDescriptor writing{-1};
};

Pipe make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("make a pipe", errno);
  const FileDescriptor reading(ends[0]);
  const FileDescriptor writing(ends[1]);
  return {raised(reading), raised(writing)};
}

void never_wait_for(const FileDescriptor& descriptor) {
  if (::fcntl(descriptor.get(), F_SETFL, O_NONBLOCK) != 0) fail("set up a pipe", errno);
}

/// Texts with the array of pointers that exec takes.
class Strings {
 public:
  explicit Strings(std::vector<std::string> texts) : texts_(std::move(texts)) {
    for (std::string& text : texts_) pointers_.push_back(text.data());
    pointers_.push_back(nullptr);
  }
  Strings(const Strings&) = delete;
  Strings& operator=(const Strings&) = delete;
  ~Strings() = default;
  [[nodiscard]] char* const* get() const { return pointers_.data(); }

 private:
  std::vector<std::string> texts_;
  std::vector<char*> pointers_;
};

std::vector<std::string> argument_texts(const WorkerCommand& command) {
  std::vector<std::string> texts{"sluice"};
  texts.insert(texts.end(), command.arguments.begin(), command.arguments.end());
  return texts;
}

std::vector<std::string> environment_texts(const WorkerCommand& command) {
  std::vector<std::string> texts{fmt::format("{}={}", kTokenVariable, command.token)};
  for (const char* name : kPassedOn) {
    if (const char* value = std::getenv(name)) texts.push_back(fmt::format("{}={}", name, value));
  }
  return texts;
}

rlim_t limit_of(std::uint64_t bytes) { return bytes == 0 ? RLIM_INFINITY : bytes; }

/// Blocks all signals of this thread for its life, so that no handler of ours runs in the child.
class SignalPause {
 public:
  SignalPause() {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  SignalPause(const SignalPause&) = delete;
  SignalPause& operator=(const SignalPause&) = delete;
  ~SignalPause() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_{};
};

pid_t fork_worker(const ChildLaunch& launch) {
  const SignalPause pause;
  const pid_t pid = ::fork();
  if (pid == 0) become_worker(launch);
  if (pid < 0) fail("make a process", errno);
  return pid;
}

/// Waits for the exec, which closes the other end, or for the report why there is none.
std::optional<LaunchFailure> launch_failure(const FileDescriptor& report) {
  LaunchFailure failure;
  ssize_t count = 0;
  do {
    count = ::read(report.get(), &failure, sizeof failure);
  } while (count < 0 && errno == EINTR);
  if (count != sizeof failure) return {};
  return failure;
}

std::optional<Sandbox> make_sandbox(const WorkerCommand& command, int program) {
  if (command.confinement == Confinement::none) return {};
  try {
    return std::optional<Sandbox>(std::in_place, command.folder, program);
  } catch (const std::system_error& error) {
    throw WorkerStartError(fmt::format("cannot start a worker: {}", error.what()));
  }
}

/// The child puts the program at a number where nothing may stand that it needs after that.
void require_free_number(const Sandbox& sandbox, const FileDescriptor& report) {
  const int number = sandbox.program_descriptor();
  if (report.get() == number || sandbox.rules_descriptor() == number) {
    fail("find a free descriptor: raise the limit of open files (ulimit -n)", EMFILE);
  }
}

}  // namespace

WorkerProcess::WorkerProcess(const WorkerCommand& command) {
  const fs::path path = command.program.empty() ? "/proc/self/exe" : command.program;
  const FileDescriptor program = open_or_fail(path.c_str(), O_PATH);
  const FileDescriptor input = open_or_fail("/dev/null", O_RDONLY);
  Pipe output = make_pipe();
  Pipe errors = make_pipe();
  Pipe report = make_pipe();
  never_wait_for(output.reading);
  never_wait_for(errors.reading);
  std::optional<Sandbox> sandbox = make_sandbox(command, program.get());
  if (sandbox) require_free_number(*sandbox, report.writing);
  const Strings arguments(argument_texts(command));
  const Strings environment(environment_texts(command));

  ChildLaunch launch;
  launch.parent = ::getpid();
  launch.input = input.get();
  launch.output = output.writing.get();
  launch.errors = errors.writing.get();
  launch.report = report.writing.get();
  launch.program = program.get();
  launch.folder = command.folder.c_str();
  launch.path = path.c_str();
  launch.arguments = arguments.get();
  launch.environment = environment.get();
  launch.address_space = limit_of(command.address_space);
  launch.largest_file = limit_of(command.largest_file);
  launch.sandbox = sandbox ? &*sandbox : nullptr;

  pid_ = fork_worker(launch);
  end_ = FileDescriptor(static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0)));
  output_ = std::move(output.reading);
  errors_ = std::move(errors.reading);
  report.writing = FileDescriptor(-1);
  if (const auto failure = launch_failure(report.reading)) {
    ::waitpid(std::exchange(pid_, -1), nullptr, 0);
    fail(failure->action, failure->error);
  }
}

WorkerProcess::WorkerProcess(WorkerProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      end_(std::move(other.end_)),
      output_(std::move(other.output_)),
      errors_(std::move(other.errors_)) {}

WorkerProcess::~WorkerProcess() {
  if (pid_ < 0) return;
  kill_group();
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void WorkerProcess::send(int signal_number) const {
  if (pid_ > 0) ::kill(pid_, signal_number);
}

void WorkerProcess::kill_group() const {
  if (pid_ <= 0) return;
  ::kill(-pid_, SIGKILL);
  // Should it have left its group.
  ::kill(pid_, SIGKILL);
}

std::optional<WorkerEnd> WorkerProcess::reap() {
  if (pid_ < 0) return {};
  siginfo_t info{};
  // Not reaped yet, it keeps its number: the group that the number names is surely its own.
  const int result = ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT);
  if (result == 0 && info.si_pid == 0) return {};
  if (result != 0 && errno == EINTR) return {};
  WorkerEnd end;
  if (result == 0) {
    ::kill(-pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    if (info.si_code == CLD_EXITED) {
      end.exit_code = info.si_status;
    } else {
      end.signal = info.si_status;
    }
  }
  pid_ = -1;
  return end;
}

}  // namespace sluice

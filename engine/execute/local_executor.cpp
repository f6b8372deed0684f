#include "engine/execute/local_executor.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>
#include <utility>

#include "engine/execute/child_launch.hpp"
#include "engine/execute/sandbox.hpp"
#include "engine/store/disk/file_system.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(std::string_view action, int error) {
  throw ProcessStartError(error, std::generic_category(), fmt::format("cannot {}", action));
}

/// The same file under a number that the child does not put anything at.
FileDescriptor raised(int descriptor) {
  FileDescriptor copy(::fcntl(descriptor, F_DUPFD_CLOEXEC, kFirstFreeDescriptor));
  if (copy.get() < 0) refuse("copy a descriptor", errno);
  return copy;
}

FileDescriptor open_raised(const char* path, int flags) {
  const FileDescriptor descriptor(::open(path, flags | O_CLOEXEC));
  if (descriptor.get() < 0) refuse(fmt::format("open {}", path), errno);
  return raised(descriptor.get());
}

struct Pipe {
  FileDescriptor reading{-1};
  FileDescriptor writing{-1};
};

Pipe make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) refuse("make a pipe", errno);
  const FileDescriptor reading(ends[0]);
  const FileDescriptor writing(ends[1]);
  return {raised(reading.get()), raised(writing.get())};
}

/// Where a stream of the process goes: to that descriptor, or into a pipe that is read here.
Pipe make_way(std::optional<int> descriptor) {
  if (descriptor) return {FileDescriptor(-1), raised(*descriptor)};
  Pipe pipe = make_pipe();
  if (::fcntl(pipe.reading.get(), F_SETFL, O_NONBLOCK) != 0) refuse("set up a pipe", errno);
  return pipe;
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

std::vector<std::string> argument_texts(const ProcessCommand& command) {
  std::vector<std::string> texts{"sluice"};
  texts.insert(texts.end(), command.arguments.begin(), command.arguments.end());
  return texts;
}

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

pid_t fork_process(const ChildLaunch& launch) {
  const SignalPause pause;
  const pid_t pid = ::fork();
  if (pid == 0) become_process(launch);
  if (pid < 0) refuse("make a process", errno);
  return pid;
}

/// Waits for the exec, which closes the other end, or for the report why there is none.
std::optional<LaunchFailure> launch_failure(const FileDescriptor& report) {
  LaunchFailure failure;
  const ssize_t count =
      uninterrupted([&] { return ::read(report.get(), &failure, sizeof failure); });
  if (count != sizeof failure) return {};
  return failure;
}

std::optional<Sandbox> make_sandbox(const ProcessCommand& command, int program) {
  if (command.confinement == Confinement::none) return {};
  return std::optional<Sandbox>(std::in_place, command.folder, program);
}

/// The child puts the program at a number where nothing may stand that it needs after that.
void require_free_number(const Sandbox& sandbox, const FileDescriptor& report) {
  const int number = sandbox.program_descriptor();
  if (report.get() == number || sandbox.rules_descriptor() == number) {
    refuse("find a free descriptor: raise the limit of open files (ulimit -n)", EMFILE);
  }
}

class LocalProcess final : public RunningProcess {
 public:
  explicit LocalProcess(const ProcessCommand& command);
  ~LocalProcess() override;

  [[nodiscard]] pid_t pid() const override { return pid_; }
  [[nodiscard]] int end_descriptor() const override { return end_.get(); }
  [[nodiscard]] int output() const override { return output_.get(); }
  [[nodiscard]] int errors() const override { return errors_.get(); }
  void send(int signal_number) override;
  void kill_group() override;
  [[nodiscard]] std::optional<ProcessEnd> reap() override;

 private:
  pid_t pid_ = -1;
  FileDescriptor end_{-1};
  FileDescriptor output_{-1};
  FileDescriptor errors_{-1};
};

LocalProcess::LocalProcess(const ProcessCommand& command) {
  const fs::path path = command.program.empty() ? "/proc/self/exe" : command.program;
  const FileDescriptor program = open_raised(path.c_str(), O_PATH);
  const FileDescriptor input =
      command.input ? raised(*command.input) : open_raised("/dev/null", O_RDONLY);
  Pipe output = make_way(command.output);
  Pipe errors = make_way(command.errors);
  Pipe report = make_pipe();
  std::optional<Sandbox> sandbox = make_sandbox(command, program.get());
  if (sandbox) require_free_number(*sandbox, report.writing);
  const Strings arguments(argument_texts(command));
  const Strings environment(command.environment.value_or(std::vector<std::string>()));
  const std::string oom_score = fmt::format("{}", command.priority.oom_score.value_or(0));

  ChildLaunch launch{command};
  launch.parent = ::getpid();
  launch.input = input.get();
  launch.output = output.writing.get();
  launch.errors = errors.writing.get();
  launch.report = report.writing.get();
  launch.program = program.get();
  launch.path = path.c_str();
  launch.arguments = arguments.get();
  launch.environment = command.environment ? environment.get() : environ;
  launch.oom_score = command.priority.oom_score ? oom_score.c_str() : nullptr;
  launch.sandbox = sandbox ? &*sandbox : nullptr;

  pid_ = fork_process(launch);
  end_ = FileDescriptor(static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0)));
  output_ = std::move(output.reading);
  errors_ = std::move(errors.reading);
  report.writing = FileDescriptor(-1);
  if (const auto failure = launch_failure(report.reading)) {
    ::waitpid(std::exchange(pid_, -1), nullptr, 0);
    refuse(failure->action, failure->error);
  }
}

LocalProcess::~LocalProcess() {
  if (pid_ < 0) return;
  LocalProcess::kill_group();
  static_cast<void>(uninterrupted([this] { return ::waitpid(pid_, nullptr, 0); }));
}

void LocalProcess::send(int signal_number) {
  if (pid_ > 0) ::kill(pid_, signal_number);
}

void LocalProcess::kill_group() {
  if (pid_ <= 0) return;
  ::kill(-pid_, SIGKILL);
  // Should it have left its group.
  ::kill(pid_, SIGKILL);
}

std::optional<ProcessEnd> LocalProcess::reap() {
  if (pid_ < 0) return {};
  siginfo_t info{};
  // Not reaped yet, it keeps its number: the group that the number names is surely its own.
  const int result = ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT);
  if (result == 0 && info.si_pid == 0) return {};
  if (result != 0 && errno == EINTR) return {};
  ProcessEnd end;
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

class LocalExecutor final : public Executor {
 public:
  [[nodiscard]] std::unique_ptr<RunningProcess> start(const ProcessCommand& command) override {
    return std::make_unique<LocalProcess>(command);
  }
  [[nodiscard]] std::string missing_confinement() const override { return Sandbox::missing(); }
};

}  // namespace

Executor& local_executor() {
  static LocalExecutor executor;
  return executor;
}

}  // namespace sluice

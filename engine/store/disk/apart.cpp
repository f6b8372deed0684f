#include "engine/store/disk/apart.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>
#include <string_view>
#include <system_error>

#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/file_system.hpp"
#include "engine/store/disk/trailer.hpp"

namespace sluice {
namespace {

using ApartClock = std::chrono::steady_clock;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // they reserve more addresses than there is memory
#else
constexpr bool kSanitized = false;
#endif

// What the first byte of a child's answer says of the rest.
constexpr char kResult = 'r';
constexpr char kStorageError = 's';  // then the fault's number and the message
constexpr char kOtherError = 'e';
// Exit codes of the child.
constexpr int kOutOfMemory = 101;
constexpr int kCannotStart = 127;

/// Addresses that this process has, bytes; 0 where it is not told.
std::uint64_t addresses_in_use() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t pages = 0;
  file >> pages;
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void limit_apart(__rlimit_resource resource, std::uint64_t wanted) {
  rlimit present{};
  ::getrlimit(resource, &present);
  const rlim_t value = std::min<rlim_t>(wanted, present.rlim_max);
  const rlimit limits{value, value};
  ::setrlimit(resource, &limits);
}

/// In the child: nothing of the parent's but its memory.
void part_from_parent(pid_t parent, int output, const ApartLimits& limits,
                      std::uint64_t addresses) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  for (int number = 1; number < SIGRTMIN; ++number) {
    static_cast<void>(::sigaction(number, &action, nullptr));
  }
  // What a terminal or a session tells its whole group is the parent's to obey.
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) ::signal(number, SIG_IGN);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const auto kept = static_cast<unsigned>(output);
  if (kept > 3) ::syscall(SYS_close_range, 3U, kept - 1, 0U);
  ::syscall(SYS_close_range, kept + 1, ~0U, 0U);
  if (limits.nice > 0) static_cast<void>(::nice(limits.nice));
  limit_apart(RLIMIT_CORE, 0);
  limit_apart(RLIMIT_FSIZE, 0);
  limit_apart(RLIMIT_CPU, static_cast<std::uint64_t>(std::ceil(limits.core_seconds)));
  if (!kSanitized && addresses > 0) limit_apart(RLIMIT_AS, addresses + limits.memory);
}

void write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) ::_exit(1);
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

/// What is left of a child.
struct Remains {
  int status = 0;
  double core_seconds = 0.0;

  [[nodiscard]] bool was_killed() const {
    return WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
  }
};

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Kills and buries it, unless it was buried.
class ForkedChild {
 public:
  explicit ForkedChild(pid_t pid) : pid_(pid) {}
  ForkedChild(const ForkedChild&) = delete;
  ForkedChild& operator=(const ForkedChild&) = delete;
  ~ForkedChild() {
    if (pid_ <= 0) return;
    kill();
    (void)bury();
  }
  void kill() const { ::kill(pid_, SIGKILL); }
  Remains bury() {
    Remains remains;
    rusage used{};
    while (::wait4(pid_, &remains.status, 0, &used) < 0 && errno == EINTR) {
    }
    pid_ = 0;
    remains.core_seconds = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
    return remains;
  }

 private:
  pid_t pid_;
};

/// Reads until the child closes its end; says what is wrong when it does not.
std::string gather(int input, const ApartLimits& limits, std::string& output) {
  const auto until = ApartClock::now() + std::chrono::duration<double>(limits.patience);
  for (;;) {
    const double left = std::chrono::duration<double>(until - ApartClock::now()).count();
    if (left <= 0.0) return fmt::format("it was not done after {} s", limits.patience);
    pollfd there{input, POLLIN, 0};
    const int ready = ::poll(&there, 1, static_cast<int>(left * 1000.0) + 1);
    if (ready <= 0) continue;
    std::array<char, 64 * 1024> block;  // NOLINT(*-member-init): filled by read
    const ssize_t count = ::read(input, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return {};
    output.append(block.data(), static_cast<std::size_t>(count));
    if (output.size() > limits.output) return fmt::format("it wrote over {} bytes", limits.output);
  }
}

/// The kernel kills what has used up its time of a core, and counts whole seconds of it.
bool is_out_of_time(const Remains& remains, const ApartLimits& limits) {
  return remains.was_killed() && remains.core_seconds > std::ceil(limits.core_seconds) - 0.5;
}

std::string death_of(const Remains& remains, const ApartLimits& limits) {
  if (!WIFSIGNALED(remains.status)) return {};
  const int number = WTERMSIG(remains.status);
  if (number == SIGXCPU || is_out_of_time(remains, limits)) {
    return fmt::format("it was not done after {} s of a core", std::ceil(limits.core_seconds));
  }
  return fmt::format("signal {} ({})", number, ::strsignal(number));
}

struct Pipe {
  FileDescriptor input;
  FileDescriptor output;
};

Pipe make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
  }
  return {FileDescriptor(ends[0]), FileDescriptor(ends[1])};
}

/// What a child that has ended left there, without waiting.
std::string what_lies_in(const Pipe& pipe) {
  std::array<char, 4096> block;  // NOLINT(*-member-init): filled by read
  ::fcntl(pipe.input.get(), F_SETFL, O_NONBLOCK);
  const ssize_t count = ::read(pipe.input.get(), block.data(), block.size());
  return {block.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0))};
}

/// Forks; the child does `in_child` with the descriptor that its output goes to, and with `errors`
/// as its stderr unless that is negative.
template <class InChild>
ApartEnd end_of_child(const ApartLimits& limits, int errors, const InChild& in_child) {
  Pipe pipe = make_pipe();
  const std::uint64_t addresses = addresses_in_use();
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid < 0) throw std::system_error(errno, std::generic_category(), "cannot start a process");
  if (pid == 0) {
    if (errors >= 0) ::dup2(errors, STDERR_FILENO);
    part_from_parent(parent, pipe.output.get(), limits, addresses);
    in_child(pipe.output.get());
    ::_exit(0);
  }
  ForkedChild child(pid);
  pipe.output = FileDescriptor(-1);
  ApartEnd end;
  end.death = gather(pipe.input.get(), limits, end.output);
  if (!end.death.empty()) child.kill();
  const Remains remains = child.bury();
  if (end.death.empty()) {
    end.death = death_of(remains, limits);
    end.killed_by_others = remains.was_killed() && !is_out_of_time(remains, limits);
  }
  if (WIFEXITED(remains.status)) end.exit_code = WEXITSTATUS(remains.status);
  return end;
}

/// Never returns by an exception: behind it lies a copy of the parent's stack.
std::string answer_of(const std::function<std::string()>& work) noexcept {
  try {
    std::string result = work();
    result.insert(result.begin(), kResult);
    return result;
  } catch (const StorageError& error) {
    return std::string{kStorageError, static_cast<char>(error.fault())} + error.what();
  } catch (const std::bad_alloc&) {
    ::_exit(kOutOfMemory);
  } catch (const std::exception& error) {
    return kOtherError + std::string(error.what());
  }
}

}  // namespace

ApartLimits ApartLimits::for_bytes(std::uint64_t bytes) {
  ApartLimits limits;
  constexpr double kSlowest = 4e6;  // bytes/s of a core
  limits.core_seconds = 2.0 + static_cast<double>(bytes) / kSlowest;
  limits.patience = 30.0 * limits.core_seconds;
  limits.memory += 16 * bytes;
  limits.output += 16 * bytes;
  return limits;
}

std::string work_apart(const ApartLimits& limits, const std::function<std::string()>& work) {
  // What the C library says of a broken heap is no news for the user.
  const FileDescriptor nowhere(::open("/dev/null", O_WRONLY | O_CLOEXEC));
  const auto try_it = [&] {
    return end_of_child(limits, nowhere.get(),
                        [&](int output) { write_all(output, answer_of(work)); });
  };
  ApartEnd end = try_it();
  if (end.killed_by_others) end = try_it();
  if (end.exit_code == kOutOfMemory) end.death = "it needs more memory than it may have";
  if (!end.death.empty()) throw ApartFailure(end.death);
  const char kind = end.output.empty() ? '\0' : end.output.front();
  if (kind == kResult) {
    end.output.erase(0, 1);
    return std::move(end.output);
  }
  if (kind == kStorageError && end.output.size() > 1) {
    throw StorageError(static_cast<StorageFault>(end.output[1]), end.output.substr(2));
  }
  if (kind == kOtherError) throw std::runtime_error(end.output.substr(1));
  throw ApartFailure(fmt::format("it ended with {} and without an answer", end.exit_code));
}

ApartEnd program_apart(const ApartLimits& limits, const std::filesystem::path& program,
                       const std::filesystem::path& folder,
                       const std::vector<std::string>& arguments) {
  // All that the child needs is made before the fork: until its exec it must not allocate.
  std::vector<const char*> words{program.c_str()};
  for (const std::string& argument : arguments) words.push_back(argument.c_str());
  words.push_back(nullptr);
  const Pipe errors = make_pipe();
  const int said = errors.output.get();
  ApartEnd end = end_of_child(limits, said, [&](int output) {
    if (::chdir(folder.c_str()) == 0 && ::dup2(output, STDOUT_FILENO) >= 0) {
      ::execv(program.c_str(), const_cast<char* const*>(words.data()));
    }
    ::_exit(kCannotStart);
  });
  end.errors = what_lies_in(errors);
  return end;
}

std::string damage_message(const std::filesystem::path& path, const ApartFailure& failure) {
  return fmt::format(
      "{}: the file is damaged and must not be used: a process that read it did not survive: {}",
      path.string(), failure.what());
}

void require_harmless(const std::filesystem::path& path, const std::function<void()>& read) {
  verify(path);
  const std::uint64_t bytes = std::filesystem::file_size(path);
  try {
    (void)work_apart(ApartLimits::for_bytes(bytes), [&] {
      read();
      return std::string();
    });
  } catch (const ApartFailure& failure) {
    throw StorageError(StorageFault::corrupt, damage_message(path, failure));
  } catch (const StorageError&) {
    throw;  // HDF5 leaks where it refuses a file: once, in the process that is gone
  } catch (const std::exception&) {
    return;  // reading it says the same
  }
}

}  // namespace sluice

#include "service/worker/orphan.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <charconv>
#include <csignal>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/file_system.hpp"
#include "service/worker/worker_environment.hpp"

namespace sluice {
namespace {

/// A file of the system's, whose size is not known before.
std::string read_all(const char* path, std::size_t limit) {
  const FileDescriptor file(::open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW));
  std::string text(limit, '\0');
  std::size_t size = 0;
  while (file.get() >= 0 && size < limit) {
    const ssize_t count = ::read(file.get(), text.data() + size, limit - size);
    if (count <= 0) break;
    size += static_cast<std::size_t>(count);
  }
  text.resize(size);
  return text;
}

std::optional<pid_t> holder_of(const JobPaths& paths) {
  const std::string text = read_all(paths.lock().c_str(), 32);
  pid_t pid = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), pid);
  if (result.ec != std::errc() || pid <= 1) return {};
  return pid;
}

bool belongs_to(pid_t pid, const std::string& token) {
  constexpr std::size_t kLongest = std::size_t{64} << 10;
  const std::string environment =
      std::string(1, '\0') + read_all(fmt::format("/proc/{}/environ", pid).c_str(), kLongest);
  std::string wanted(1, '\0');
  wanted += fmt::format("{}={}", kTokenVariable, token);
  wanted += '\0';
  return environment.find(wanted) != std::string::npos;
}

}  // namespace

bool is_in_use(const JobPaths& paths) {
  try {
    const FolderLock lock(paths.lock());
    return false;
  } catch (const StorageError& error) {
    return error.fault() == StorageFault::locked;
  }
}

bool kill_orphan(const JobPaths& paths, const std::string& token) {
  const std::optional<pid_t> pid = holder_of(paths);
  if (!pid || token.empty()) return false;
  // Held before it is looked at, so that the number cannot pass to another process in between.
  const FileDescriptor process(static_cast<int>(::syscall(SYS_pidfd_open, *pid, 0)));
  if (process.get() < 0 || !belongs_to(*pid, token)) return false;
  return ::syscall(SYS_pidfd_send_signal, process.get(), SIGKILL, nullptr, 0) == 0;
}

}  // namespace sluice

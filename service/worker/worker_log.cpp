#include "service/worker/worker_log.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

#include "service/worker/worker_message.hpp"

namespace sluice {
namespace {

constexpr std::size_t kTail = 4096;
constexpr std::size_t kLongestLine = 500;

FileDescriptor open_log(const std::filesystem::path& path) {
  // The worker may write in this folder: what it puts there must not lead elsewhere.
  FileDescriptor file(::open(
      path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0644));
  struct stat status {};
  if (file.get() < 0 || ::fstat(file.get(), &status) != 0) return file;
  if (!S_ISREG(status.st_mode) || status.st_nlink > 1) return FileDescriptor(-1);
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size + WorkerLog::kLongestAttempt > WorkerLog::kLongestFile) {
    static_cast<void>(::ftruncate(file.get(), 0) == 0);
  }
  return file;
}

}  // namespace

WorkerLog::WorkerLog(const std::filesystem::path& folder, std::string_view head)
    : file_(open_log(folder / kWorkerLogName)) {
  put(head);
}

void WorkerLog::append(std::string_view bytes) {
  tail_.append(bytes);
  if (tail_.size() > kTail) tail_.erase(0, tail_.size() - kTail);
  if (room_ == 0) return;
  const std::size_t count = std::min(room_, bytes.size());
  put(bytes.substr(0, count));
  room_ -= count;
  if (room_ == 0) put("\n--- the rest of this attempt is left out\n");
}

std::string WorkerLog::last_line() const {
  std::string_view text = tail_;
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.remove_suffix(1);
  const std::size_t before = text.rfind('\n');
  if (before != std::string_view::npos) text.remove_prefix(before + 1);
  return printable(text, kLongestLine);
}

void WorkerLog::put(std::string_view bytes) const {
  if (file_.get() >= 0) static_cast<void>(::write(file_.get(), bytes.data(), bytes.size()) > 0);
}

}  // namespace sluice

#include "service/jobs/data_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>

#include "service/jobs/job_store.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;
using Fault = JobStoreError::Fault;

constexpr std::string_view kStopped = "stopped";
constexpr std::size_t kLength = 24;

[[noreturn]] void fail(std::string_view action, const fs::path& path, int error) {
  const bool full = error == ENOSPC || error == EDQUOT;
  throw JobStoreError(
      full ? Fault::disk_full : Fault::io,
      fmt::format("{}: {}: {}; {}", path.string(), action, std::generic_category().message(error),
                  full ? "make room on its disk"
                       : "the service needs a data folder that its user may write in"));
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  const bool made = fs::create_directories(folder, error);
  if (error) fail("cannot make the folder", folder, error.value());
  // A power cut must not take back a folder whose jobs were acknowledged.
  if (made) FileSystem::real().sync_folder(folder / "..");
}

FileDescriptor open_lock(const fs::path& data) {
  make_folder(data);
  make_folder(data / "jobs");
  const fs::path path = data / "lock";
  FileDescriptor descriptor(
      ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666));
  if (descriptor.get() < 0) fail("cannot open the lock file", path, errno);
  struct stat status {};
  if (::fstat(descriptor.get(), &status) != 0) fail("cannot look at the file", path, errno);
  if (!S_ISREG(status.st_mode)) fail("is no regular file", path, EINVAL);
  return descriptor;
}

/// The one word in the file.
std::string content(const FileDescriptor& descriptor) {
  std::array<char, kLength> text{};
  const ssize_t count = ::pread(descriptor.get(), text.data(), text.size(), 0);
  const std::string_view all(text.data(), static_cast<std::size_t>(count > 0 ? count : 0));
  return std::string(all.substr(0, all.find_first_of(" \n")));
}

/// False with errno set.
bool write_content(const FileDescriptor& descriptor, std::string_view word) {
  const std::string text = fmt::format("{:<{}}\n", word, kLength - 1);
  return ::pwrite(descriptor.get(), text.data(), text.size(), 0) == ssize_t{kLength} &&
         ::fsync(descriptor.get()) == 0;
}

void take(const FileDescriptor& descriptor, const fs::path& data) {
  int result = 0;
  do {
    result = ::flock(descriptor.get(), LOCK_EX | LOCK_NB);
  } while (result != 0 && errno == EINTR);
  if (result == 0) return;
  if (errno != EWOULDBLOCK) fail("cannot lock the file", data / "lock", errno);
  const std::string holder = content(descriptor);
  const bool number = !holder.empty() && holder.find_first_not_of("0123456789") == holder.npos;
  throw JobStoreError(
      Fault::in_use, fmt::format("{}: another service uses this data folder ({}); stop it, or give "
                                 "this one a folder of its own",
                                 data.string(), number ? "process " + holder : "unknown process"));
}

}  // namespace

DataLock::DataLock(const fs::path& data) : path_(data / "lock"), descriptor_(open_lock(data)) {
  take(descriptor_, data);
  last_stop_ = content(descriptor_) == kStopped ? LastStop::clean : LastStop::unclean;
  if (!write_content(descriptor_, std::to_string(::getpid()))) fail("cannot write", path_, errno);
}

std::string DataLock::trouble() const {
  struct stat held {};
  struct stat found {};
  const bool ours = ::fstat(descriptor_.get(), &held) == 0 && ::lstat(path_.c_str(), &found) == 0 &&
                    held.st_dev == found.st_dev && held.st_ino == found.st_ino;
  if (!ours) return "the data folder was removed, moved away or replaced; stop the service first";
  for (const fs::path& folder : {path_.parent_path(), path_.parent_path() / "jobs"}) {
    if (::access(folder.c_str(), R_OK | W_OK | X_OK) == 0) continue;
    return fmt::format("{}: {}", folder.string(), std::generic_category().message(errno));
  }
  if (::access((path_.parent_path() / "jobs.sqlite").c_str(), R_OK | W_OK) == 0) return {};
  return fmt::format("jobs.sqlite: {}", std::generic_category().message(errno));
}

void DataLock::note_clean_stop() { (void)write_content(descriptor_, kStopped); }

}  // namespace sluice

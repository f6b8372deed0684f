#include "engine/store/files/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <string>

#include "engine/store/disk/errors.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

FileDescriptor open_lock(const fs::path& path) {
  FileDescriptor descriptor(uninterrupted([&] {
    return ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
  }));
  if (descriptor.get() >= 0) {
    return descriptor;
  }
  if (errno == ELOOP || errno == EISDIR || errno == ENXIO) {
    throw StorageError(StorageFault::not_ours,
                       fmt::format("{}: the lock file is a link or no regular file; this is no "
                                   "folder of ours, or remove that file",
                                   path.string()));
  }
  throw system_error("cannot open the lock file", path, errno);
}

/// Several names for one lock file would lock jobs that have nothing to do with each other.
void require_plain_file(const FileDescriptor& descriptor, const fs::path& path) {
  struct stat status {};
  if (::fstat(descriptor.get(), &status) != 0) {
    throw system_error("cannot look at the lock file", path, errno);
  }
  if (!S_ISREG(status.st_mode) || status.st_nlink > 1) {
    throw StorageError(StorageFault::not_ours,
                       fmt::format("{}: the lock file is no regular file of one name; this is no "
                                   "folder of ours, or remove that file",
                                   path.string()));
  }
}

/// Throws StorageError where the system cannot tell: that is no answer.
bool is_still_at(int descriptor, const fs::path& path) {
  struct stat held {};
  struct stat named {};
  if (::fstat(descriptor, &held) != 0) {
    throw system_error("cannot look at", path, errno);
  }
  if (::lstat(path.c_str(), &named) != 0) {
    if (errno == ENOENT || errno == ENOTDIR) return false;
    throw system_error("cannot look at", path, errno);
  }
  return held.st_dev == named.st_dev && held.st_ino == named.st_ino;
}

/// What the holder wrote into the lock file, for the message; it is not what locks.
std::string holder(const FileDescriptor& descriptor) {
  std::array<char, 32> text{};
  const ssize_t count = ::pread(descriptor.get(), text.data(), text.size(), 0);
  long process = 0;
  const auto length = static_cast<std::size_t>(std::max<ssize_t>(count, 0));
  const auto result = std::from_chars(text.data(), text.data() + length, process);
  return result.ec == std::errc() ? fmt::format("process {}", process) : "another process";
}

void lock_or_throw(const FileDescriptor& descriptor, const fs::path& path) {
  const int result = uninterrupted([&] { return ::flock(descriptor.get(), LOCK_EX | LOCK_NB); });
  if (result != 0 && errno == EWOULDBLOCK) {
    throw StorageError(StorageFault::locked,
                       fmt::format("{}: this job is being run by {}; wait for it or stop it first",
                                   path.parent_path().string(), holder(descriptor)));
  }
  if (result != 0) {
    throw system_error("cannot lock", path, errno);
  }
}

/// Only for messages: the lock holds even when the disk is too full for a number.
void write_holder(const FileDescriptor& descriptor) {
  const std::string text = fmt::format("{}\n", ::getpid());
  if (::ftruncate(descriptor.get(), 0) == 0) {
    [[maybe_unused]] const ssize_t count = ::pwrite(descriptor.get(), text.data(), text.size(), 0);
  }
}

FileDescriptor take_lock(const fs::path& path) {
  while (true) {
    FileDescriptor descriptor = open_lock(path);
    require_plain_file(descriptor, path);
    lock_or_throw(descriptor, path);
    // Someone may have removed the file between opening and locking: then nobody else sees this
    // lock.
    if (is_still_at(descriptor.get(), path)) {
      write_holder(descriptor);
      return descriptor;
    }
  }
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& path) : descriptor_(take_lock(path)) {}

FolderLock::~FolderLock() {
  // While it is locked: afterwards the number may be the next holder's.
  if (descriptor_.get() < 0) return;
  [[maybe_unused]] const int result = ::ftruncate(descriptor_.get(), 0);
}

bool FolderLock::is_at(const std::filesystem::path& path) const {
  return is_still_at(descriptor_.get(), path);
}

}  // namespace sluice

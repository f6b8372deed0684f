#include "engine/store/disk/file_system.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <limits>
#include <system_error>
#include <utility>

#include "engine/store/disk/errors.hpp"

namespace sluice {

namespace fs = std::filesystem;

namespace {

/// The system may stop a larger write; Linux takes at most 2 GiB at once.
constexpr std::size_t kLargestWrite = std::size_t{1} << 30;

/// A read that fails is made once more: what a passing error condemned would be lost for good.
constexpr int kReadTries = 2;

}  // namespace

std::uint64_t FileSystem::free_bytes(const std::filesystem::path& folder) {
  struct statvfs status {};
  // Some network file systems report no blocks at all; the write itself decides there.
  if (::statvfs(folder.c_str(), &status) != 0 || status.f_blocks == 0) {
    return std::numeric_limits<std::uint64_t>::max();
  }
  return static_cast<std::uint64_t>(status.f_bavail) * status.f_frsize;
}

int FileSystem::create_exclusive(const std::filesystem::path& path) {
  return uninterrupted([&] {
    return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
  });
}

ssize_t FileSystem::write(int descriptor, const void* bytes, std::size_t count) {
  return uninterrupted([&] { return ::write(descriptor, bytes, count); });
}

int FileSystem::sync(int descriptor) {
  return uninterrupted([&] { return ::fsync(descriptor); });
}

int FileSystem::close(int descriptor) { return ::close(descriptor); }

int FileSystem::rename(const std::filesystem::path& from, const std::filesystem::path& to) {
  return std::rename(from.c_str(), to.c_str());
}

int FileSystem::sync_folder(const std::filesystem::path& folder) {
  const FileDescriptor descriptor(
      uninterrupted([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); }));
  if (descriptor.get() < 0) {
    return -1;
  }
  const int result = uninterrupted([&] { return ::fsync(descriptor.get()); });
  // A file system that knows no sync of folders has nothing more to offer.
  return result != 0 && errno == EINVAL ? 0 : result;
}

FileSystem& FileSystem::real() {
  static FileSystem system;
  return system;
}

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

FileDescriptor::~FileDescriptor() {
  if (descriptor_ >= 0) {
    const int saved = errno;
    ::close(descriptor_);
    errno = saved;
  }
}

int FileDescriptor::release() { return std::exchange(descriptor_, -1); }

void write_whole(FileSystem& system, int descriptor, ByteSpan bytes,
                 const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t count =
        system.write(descriptor, bytes.data(), std::min(bytes.size(), kLargestWrite));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw system_error("cannot write", path, errno);
    if (count == 0) throw system_error("cannot write", path, ENOSPC);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

InputFile::InputFile(const std::filesystem::path& path, Links links)
    // Without O_NONBLOCK the opening of a pipe waits for its writer.
    : path_(path), descriptor_(uninterrupted([&] {
        return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK |
                                        (links == Links::refuse ? O_NOFOLLOW : 0));
      })) {
  if (descriptor_.get() < 0 && errno == ELOOP && links == Links::refuse) {
    throw StorageError(StorageFault::corrupt,
                       fmt::format("{}: this is a symbolic link, and none is followed here; put "
                                   "the file itself in its place",
                                   path.string()));
  }
  if (descriptor_.get() < 0) {
    throw system_error("cannot open", path, errno);
  }
  struct stat status {};
  if (::fstat(descriptor_.get(), &status) != 0) {
    throw system_error("cannot look at", path, errno);
  }
  if (!S_ISREG(status.st_mode)) {
    throw StorageError(StorageFault::corrupt,
                       fmt::format("{}: this is no regular file", path.string()));
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

void InputFile::read(std::uint64_t offset, std::span<std::byte> into) const {
  int tries = 0;
  while (!into.empty()) {
    const ssize_t count =
        ::pread(descriptor_.get(), into.data(), into.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count < 0 && errno != EIO) {
      throw system_error("cannot read", path_, errno);
    }
    if (count < 0 && ++tries < kReadTries) {
      continue;
    }
    if (count <= 0) {  // A medium that gives an error here has lost the file as much as a short one
      throw StorageError(StorageFault::corrupt,
                         fmt::format("{}: cannot be read from byte {} on", path_.string(), offset));
    }
    into = into.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

void InputFile::drop_cache() const {
  // Only a hint: where it is refused the check reads the system's copy.
  (void)::posix_fadvise(descriptor_.get(), 0, 0, POSIX_FADV_DONTNEED);
}

fs::file_type file_type_at(const fs::path& path) {
  std::error_code error;
  const fs::file_type type = fs::status(path, error).type();
  if (type == fs::file_type::none) {
    throw system_error("cannot look at", path, error.value());
  }
  return type;
}

std::vector<fs::directory_entry> entries_of(const fs::path& folder) {
  std::vector<fs::directory_entry> entries;
  std::error_code error;
  fs::directory_iterator entry;
  do {
    entry = fs::directory_iterator(folder, error);
  } while (error == std::errc::interrupted);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    entries.push_back(*entry);
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    throw system_error("cannot list the folder", folder, error.value());
  }
  return entries;
}

std::string read_text(const std::filesystem::path& path, std::uint64_t limit, Links links) {
  const InputFile file(path, links);
  if (file.size() > limit) {
    throw StorageError(StorageFault::not_ours,
                       fmt::format("{}: holds {} bytes where at most {} are allowed", path.string(),
                                   file.size(), limit));
  }
  std::string text(static_cast<std::size_t>(file.size()), '\0');
  file.read(0, std::as_writable_bytes(std::span(text)));
  return text;
}

}  // namespace sluice

#pragma once

#include <sys/types.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace sluice {

/// The system calls that publishing a file goes through, so that a test can make any one of them
/// fail. Each returns what the system call returns and sets errno.
class FileSystem {
 public:
  FileSystem() = default;
  FileSystem(const FileSystem&) = delete;
  FileSystem& operator=(const FileSystem&) = delete;
  virtual ~FileSystem() = default;

  /// Bytes that may still be written in `folder`; the largest number when the system cannot tell.
  virtual std::uint64_t free_bytes(const std::filesystem::path& folder);
  virtual int create_exclusive(const std::filesystem::path& path);
  virtual ssize_t write(int descriptor, const void* bytes, std::size_t count);
  virtual int sync(int descriptor);
  virtual int close(int descriptor);
  virtual int rename(const std::filesystem::path& from, const std::filesystem::path& to);
  virtual int sync_folder(const std::filesystem::path& folder);

  /// The machine's own.
  [[nodiscard]] static FileSystem& real();
};

/// Makes a system call again for as long as signals interrupt it.
template <class Call>
auto uninterrupted(const Call& call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

/// An open file, closed at the end of its life.
class FileDescriptor {
 public:
  explicit FileDescriptor(int descriptor) : descriptor_(descriptor) {}
  FileDescriptor(FileDescriptor&& other) noexcept : descriptor_(other.release()) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;
  ~FileDescriptor();

  [[nodiscard]] int get() const { return descriptor_; }
  /// Gives the descriptor away: the caller closes it.
  [[nodiscard]] int release();

 private:
  int descriptor_;
};

using Bytes = std::vector<std::byte>;
using ByteSpan = std::span<const std::byte>;

/// Writes all bytes, in as many calls as it takes. Throws StorageError with `path`, the name that
/// people know the file by.
void write_whole(FileSystem& system, int descriptor, ByteSpan bytes,
                 const std::filesystem::path& path);

/// Whether a name that is a symbolic link stands for what it points to, or is refused.
enum class Links { follow, refuse };

/// A regular file opened for reading. Pipes, devices and folders are refused without waiting on
/// them.
class InputFile {
 public:
  /// Throws StorageError: io or unwritable when it cannot be opened, corrupt when it is no regular
  /// file or a link that is refused.
  explicit InputFile(const std::filesystem::path& path, Links links = Links::follow);
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Fills `into` from `offset` on; a file that ends before is corrupt.
  void read(std::uint64_t offset, std::span<std::byte> into) const;
  /// Asks the system to forget its copy, so that the next read comes from the disk.
  void drop_cache() const;

 private:
  std::filesystem::path path_;
  FileDescriptor descriptor_;
  std::uint64_t size_ = 0;
};

/// What lies at `path`, links followed; not_found where nothing does. Throws StorageError when the
/// system cannot tell: what cannot be looked at is not missing.
[[nodiscard]] std::filesystem::file_type file_type_at(const std::filesystem::path& path);
[[nodiscard]] inline bool is_present(const std::filesystem::path& path) {
  return file_type_at(path) != std::filesystem::file_type::not_found;
}

/// All that a folder holds, in no order; nothing where there is no folder. Throws StorageError.
[[nodiscard]] std::vector<std::filesystem::directory_entry> entries_of(
    const std::filesystem::path& folder);

/// A whole text file. One above `limit` bytes is refused as not ours.
[[nodiscard]] std::string read_text(const std::filesystem::path& path, std::uint64_t limit,
                                    Links links = Links::follow);

}  // namespace sluice

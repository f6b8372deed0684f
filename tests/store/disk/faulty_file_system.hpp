#pragma once

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>

#include "engine/store/disk/file_system.hpp"

namespace sluice::test {

/// A call of FileSystem.
enum class Step { create, write, sync, close, rename, sync_folder };

/// Lets one call fail, or does something before it.
class FaultyFileSystem : public FileSystem {
 public:
  explicit FaultyFileSystem(Step step, std::function<int()> fault)
      : step_(step), fault_(std::move(fault)) {}

  int create_exclusive(const std::filesystem::path& path) override {
    return fails(Step::create) ? -1 : FileSystem::create_exclusive(path);
  }
  ssize_t write(int descriptor, const void* bytes, std::size_t count) override {
    // Some bytes are written before the write that fails.
    if (++writes_ > 1 && fails(Step::write)) {
      return -1;
    }
    return FileSystem::write(descriptor, bytes, std::min<std::size_t>(count, 1000));
  }
  int sync(int descriptor) override {
    return fails(Step::sync) ? -1 : FileSystem::sync(descriptor);
  }
  int close(int descriptor) override {
    const int result = FileSystem::close(descriptor);
    return fails(Step::close) ? -1 : result;
  }
  int rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
    return fails(Step::rename) ? -1 : FileSystem::rename(from, to);
  }
  int sync_folder(const std::filesystem::path& folder) override {
    return fails(Step::sync_folder) ? -1 : FileSystem::sync_folder(folder);
  }

 private:
  bool fails(Step step) {
    if (step != step_) {
      return false;
    }
    errno = fault_();
    return errno != 0;
  }

  Step step_;
  std::function<int()> fault_;
  int writes_ = 0;
};

/// A disk that takes every byte and stores another.
class LyingFileSystem : public FileSystem {
 public:
  ssize_t write(int descriptor, const void* bytes, std::size_t count) override {
    const auto* first = static_cast<const std::byte*>(bytes);
    Bytes altered(first, first + count);
    altered.back() ^= std::byte{1};
    return FileSystem::write(descriptor, altered.data(), count);
  }
};

/// Which of the calls that make a file survive a power cut were made.
class NotingFileSystem : public FileSystem {
 public:
  int sync(int descriptor) override {
    calls += "file ";
    return FileSystem::sync(descriptor);
  }
  int rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
    calls += "rename ";
    return FileSystem::rename(from, to);
  }
  int sync_folder(const std::filesystem::path& folder) override {
    calls += "folder ";
    return FileSystem::sync_folder(folder);
  }
  std::string calls;
};

}  // namespace sluice::test

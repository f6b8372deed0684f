#include "engine/store/disk/publish.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <functional>
#include <string>
#include <system_error>
#include <utility>

#include "engine/store/disk/errors.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTemporarySuffix = ".tmp";

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

/// `.NAME.PID.NUMBER.tmp`: hidden, and not one of the names that readers look for.
fs::path temporary_path(const fs::path& target) {
  static std::atomic<std::uint64_t> number = 0;
  return folder_of(target) / fmt::format(".{}.{}.{}{}", target.filename().string(), ::getpid(),
                                         number.fetch_add(1), kTemporarySuffix);
}

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Cuts the last `.PART` off `name` and returns PART.
std::string_view take_last_part(std::string_view& name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) {
    return {};
  }
  const std::string_view part = name.substr(dot + 1);
  name.remove_suffix(name.size() - dot);
  return part;
}

bool is_temporary_name(std::string_view name) {
  if (!name.starts_with('.') || !name.ends_with(kTemporarySuffix)) {
    return false;
  }
  name.remove_suffix(kTemporarySuffix.size());
  const bool numbered = is_number(take_last_part(name)) && is_number(take_last_part(name));
  return numbered && name.size() > 1;
}

/// The file under its temporary name; removed at the end of its life unless it was moved away.
class Temporary {
 public:
  Temporary(const fs::path& target, FileSystem& system) : target_(target), system_(system) {
    do {
      path_ = temporary_path(target);
      descriptor_ = system.create_exclusive(path_);
    } while (descriptor_ < 0 && (errno == EEXIST || errno == EINTR));
    if (descriptor_ < 0) {
      throw system_error("cannot make a temporary file beside it", target_, errno);
    }
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    if (descriptor_ >= 0) {
      system_.close(descriptor_);
    }
    if (!path_.empty()) {
      std::error_code ignored;
      fs::remove(path_, ignored);
    }
  }

  [[nodiscard]] const fs::path& path() const { return path_; }

  void write(ByteSpan bytes) { write_whole(system_, descriptor_, bytes, target_); }

  void sync() {
    if (system_.sync(descriptor_) != 0) {
      throw system_error("cannot bring to the disk", target_, errno);
    }
  }

  /// Network file systems and quotas may report a failed write only here.
  void close() {
    const int descriptor = std::exchange(descriptor_, -1);
    if (system_.close(descriptor) != 0 && errno != EINTR) {
      throw system_error("cannot close", target_, errno);
    }
  }

  void move_to_target() {
    if (system_.rename(path_, target_) != 0) {
      throw system_error("cannot put the new file in place", target_, errno);
    }
    path_.clear();
  }

 private:
  fs::path target_;
  FileSystem& system_;
  fs::path path_;
  int descriptor_ = -1;
};

void require_free(std::uint64_t bytes, const fs::path& target, FileSystem& system) {
  const std::uint64_t free = system.free_bytes(folder_of(target));
  if (free < bytes) {
    throw StorageError(
        StorageFault::disk_full,
        fmt::format("{}: needs {} bytes where {} are free; make room on this disk and run again: "
                    "what was saved before is whole",
                    target.string(), bytes, free));
  }
}

void sync_folder_of(const fs::path& target, FileSystem& system) {
  if (system.sync_folder(folder_of(target)) != 0) {
    throw system_error("cannot bring the folder to the disk", folder_of(target), errno);
  }
}

/// Reads from the disk rather than from the system's copy where the bytes have been synced.
void verify_image(const fs::path& path, Durability durability) {
  if (durability == Durability::power_cut) {
    InputFile(path).drop_cache();
  }
  verify(path);
}

void verify_text(const fs::path& path, std::string_view text) {
  if (read_text(path, text.size()) != text) {
    throw StorageError(StorageFault::corrupt, "other text than was written");
  }
}

/// What reads back damaged right after it was written is no damaged file but a failed write.
void verify_written(const fs::path& target, const std::function<void()>& check) {
  try {
    check();
  } catch (const StorageError& error) {
    throw StorageError(StorageFault::io,
                       fmt::format("{}: what was written reads back wrong, so it was not put in "
                                   "place; check the disk and the memory ({})",
                                   target.string(), error.what()));
  }
}

using Check = std::function<void(const fs::path&)>;

/// The commit protocol. `check` reads the temporary back and throws when it is not what was meant.
void commit(const fs::path& target, std::initializer_list<ByteSpan> parts, Durability durability,
            const Check& check, FileSystem& system) {
  std::uint64_t length = 0;
  for (const ByteSpan& part : parts) {
    length += part.size();
  }
  require_free(length, target, system);
  Temporary temporary(target, system);
  for (const ByteSpan& part : parts) {
    temporary.write(part);
  }
  if (durability == Durability::power_cut) {
    temporary.sync();
  }
  temporary.close();
  verify_written(target, [&] { check(temporary.path()); });
  temporary.move_to_target();
  if (durability == Durability::power_cut) {
    sync_folder_of(target, system);
  }
}

}  // namespace

void publish(const fs::path& target, ByteSpan image, Durability durability, FileSystem& system) {
  const auto trailer = make_trailer(image).encode();
  const Check check = [&](const fs::path& path) { verify_image(path, durability); };
  commit(target, {image, trailer}, durability, check, system);
}

void publish_text(const fs::path& target, std::string_view text, FileSystem& system) {
  const Check check = [&](const fs::path& path) { verify_text(path, text); };
  commit(target, {std::as_bytes(std::span(text))}, Durability::power_cut, check, system);
}

void write_text(const fs::path& target, std::string_view text, FileSystem& system) {
  std::error_code unknown;  // then publishing says what is wrong
  const fs::file_type type = fs::symlink_status(target, unknown).type();
  if (unknown || type == fs::file_type::not_found || type == fs::file_type::regular) {
    return publish_text(target, text, system);
  }
  if (fs::is_directory(target, unknown)) {
    throw StorageError(StorageFault::io,
                       fmt::format("{}: is a folder; name a file to write", target.string()));
  }
  FileDescriptor file(uninterrupted(
      [&] { return ::open(target.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666); }));
  if (file.get() < 0) throw system_error("cannot open for writing", target, errno);
  write_whole(system, file.get(), std::as_bytes(std::span(text)), target);
  if (system.close(file.release()) != 0 && errno != EINTR) {
    throw system_error("cannot close", target, errno);
  }
}

bool has_leftovers(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (is_temporary_name(entry->path().filename().string())) return true;
  }
  return false;
}

std::size_t remove_leftovers(const fs::path& folder) {
  std::size_t removed = 0;
  std::error_code ignored;  // what cannot be removed now, the next holder finds again
  try {
    for (const fs::directory_entry& entry : entries_of(folder)) {
      if (is_temporary_name(entry.path().filename().string()) &&
          entry.symlink_status(ignored).type() == fs::file_type::regular &&
          fs::remove(entry.path(), ignored)) {
        ++removed;
      }
    }
  } catch (const StorageError&) {
  }
  return removed;
}

}  // namespace sluice

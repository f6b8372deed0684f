#include "engine/store/files/new_folder.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "engine/store/disk/errors.hpp"
#include "engine/store/files/job_folder.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kUnfinished = ".new";

fs::path unfinished_path(const fs::path& target) {
  return target.parent_path() / fmt::format(".{}{}", target.filename().string(), kUnfinished);
}

void make_subfolder(const fs::path& folder) {
  std::error_code error;
  if (!fs::create_directory(folder, error)) {
    throw system_error("cannot make the folder", folder, error ? error.value() : EEXIST);
  }
}

/// A folder under its hidden name; removed with all in it unless it was moved to its place.
class UnfinishedFolder {
 public:
  UnfinishedFolder(const fs::path& target, FileSystem& system)
      : target_(target), path_(unfinished_path(target)), system_(system) {
    make_subfolder(path_);
  }
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;
  ~UnfinishedFolder() {
    for (const Written& file : files_) system_.close(file.descriptor);
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }

  [[nodiscard]] const fs::path& path() const { return path_; }

  /// The text stays the caller's until `sync`.
  void write(std::string_view name, std::string_view text) {
    const fs::path shown = target_ / name;
    const int descriptor = system_.create_exclusive(path_ / name);
    if (descriptor < 0) throw system_error("cannot make the file", shown, errno);
    files_.push_back({std::string(name), text, descriptor});
    write_whole(system_, descriptor, std::as_bytes(std::span(text)), shown);
  }

  /// All files are written before the first is synced, so that a journalling file system brings
  /// them to the disk together.
  void sync() {
    for (const Written& file : files_) {
      if (system_.sync(file.descriptor) != 0) {
        throw system_error("cannot bring to the disk", target_ / file.name, errno);
      }
    }
    while (!files_.empty()) {
      const Written file = std::move(files_.back());
      files_.pop_back();
      close(file);
    }
    sync_folder(path_);
  }

  void move_to_place() {
    if (system_.rename(path_, target_) != 0) {
      throw system_error("cannot put the new folder in place", target_, errno);
    }
    path_ = target_;  // removed after all, should the disk refuse its name
    sync_folder(target_.parent_path());
    path_.clear();
  }

 private:
  struct Written {
    std::string name;
    std::string_view text;
    int descriptor;
  };

  void close(const Written& file) const {
    if (system_.close(file.descriptor) != 0 && errno != EINTR) {
      throw system_error("cannot close", target_ / file.name, errno);
    }
    if (read_text(path_ / file.name, file.text.size()) != file.text) {
      throw StorageError(StorageFault::io,
                         fmt::format("{}: what was written reads back wrong; check the disk and "
                                     "the memory",
                                     (target_ / file.name).string()));
    }
  }

  void sync_folder(const fs::path& folder) const {
    if (system_.sync_folder(folder) != 0) {
      throw system_error("cannot bring the folder to the disk", folder, errno);
    }
  }

  fs::path target_;
  fs::path path_;
  FileSystem& system_;
  std::vector<Written> files_;
};

bool is_unfinished(const fs::directory_entry& entry) {
  const std::string name = entry.path().filename().string();
  std::error_code ignored;
  return name.starts_with('.') && name.ends_with(kUnfinished) &&
         entry.symlink_status(ignored).type() == fs::file_type::directory;
}

}  // namespace

void publish_folder(const fs::path& target, std::span<const FirstFile> files,
                    std::span<const std::string_view> folders, FileSystem& system) {
  if (storing([&] { return fs::exists(fs::symlink_status(target)); })) {
    throw StorageError(StorageFault::already_exists,
                       fmt::format("{}: is there already; choose another folder", target.string()));
  }
  UnfinishedFolder folder(target, system);
  for (const std::string_view name : folders) make_subfolder(folder.path() / name);
  for (const FirstFile& file : files) folder.write(file.name, file.text);
  folder.sync();
  folder.move_to_place();
}

void publish_job_folder(const fs::path& target, std::string_view scene_text,
                        const std::vector<FirstFile>& more, FileSystem& system) {
  const JobPaths paths(target);
  const std::string scene = paths.scene().filename().string();
  const std::string frames = paths.frames().filename().string();
  std::vector<FirstFile> files{{scene, scene_text}};
  files.insert(files.end(), more.begin(), more.end());
  publish_folder(target, files, std::array<std::string_view, 1>{frames}, system);
}

std::size_t remove_unfinished_folders(const fs::path& parent) {
  std::size_t removed = 0;
  for (const fs::directory_entry& entry : entries_of(parent)) {
    std::error_code ignored;  // the next start finds what cannot be removed now
    if (!is_unfinished(entry)) continue;
    fs::remove_all(entry.path(), ignored);
    ++removed;
  }
  return removed;
}

}  // namespace sluice

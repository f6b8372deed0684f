#pragma once

#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

namespace sluice {

/// What kind of storage failure it is, for those who must act on it; the message is for people.
enum class StorageFault {
  disk_full,   ///< no room, quota or file size limit reached: make room and go on
  io,          ///< the system refused to read, write or rename
  unwritable,  ///< no permission to write, or mounted read-only
  corrupt,     ///< a file of ours that is cut short, altered or not laid out as it must be, or
               ///< something else, such as a link, in a file's or folder's place
  unsupported_version,   ///< written by a newer program
  wrong_scene,           ///< whole, but of another scene or another integrator
  invalid_content,       ///< what was to be written breaks the layout's rules; nothing was written
  not_ours,              ///< not a job folder or not one of our files
  already_exists,        ///< the folder holds a job already
  locked,                ///< another process runs this job
  no_usable_checkpoint,  ///< checkpoints exist, none of them can be used
  lost,                  ///< the folder that is held is no longer there, or others may hold it too
};
[[nodiscard]] std::string_view to_string(StorageFault fault);

/// Thrown by everything in engine/store. The message says what failed, where and what to do.
class StorageError : public std::runtime_error {
 public:
  StorageError(StorageFault fault, const std::string& message)
      : std::runtime_error(message), fault_(fault) {}
  [[nodiscard]] StorageFault fault() const { return fault_; }

 private:
  StorageFault fault_;
};

/// The error of a failed system call: `action` ("cannot write"), the path and the meaning of
/// `error_number`, with the fault that belongs to it.
[[nodiscard]] StorageError system_error(std::string_view action, const std::filesystem::path& path,
                                        int error_number);

/// The same of an error of std::filesystem: the path it names, and the fault of its error number.
[[nodiscard]] StorageError system_error(const std::filesystem::filesystem_error& error);

/// Does `action`, which makes and writes a file's image: errors of std::filesystem and a want of
/// memory come out as StorageErrors too, so that whoever tries again has one thing to wait for.
template <class Action>
auto storing(const Action& action) {
  try {
    return action();
  } catch (const std::filesystem::filesystem_error& error) {
    throw system_error(error);
  } catch (const std::bad_alloc&) {
    throw StorageError(StorageFault::io, "no memory left for what was to be written");
  }
}

/// The same fault with the path put before the message unless it is there.
[[nodiscard]] StorageError in_file(const std::filesystem::path& path, const StorageError& error);

/// A message whose paths begin with "./" because its writer stands in the folder `root`, for those
/// who do not. One that was told so already stays as it is.
[[nodiscard]] std::string told_outside(const std::filesystem::path& root, std::string message);
[[nodiscard]] StorageError told_outside(const std::filesystem::path& root,
                                        const StorageError& error);

/// Does `action` and puts the path before the message of its StorageError.
template <class Action>
auto naming(const std::filesystem::path& path, const Action& action) {
  try {
    return action();
  } catch (const StorageError& error) {
    throw in_file(path, error);
  }
}

}  // namespace sluice

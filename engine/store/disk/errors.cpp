#include "engine/store/disk/errors.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>

namespace sluice {
namespace {

StorageFault fault_of(int error_number) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return StorageFault::disk_full;
    case EACCES:
    case EPERM:
    case EROFS:
      return StorageFault::unwritable;
    case EEXIST:
    case ENOTDIR:
    case EISDIR:
    case ELOOP:
      return StorageFault::corrupt;
    default:
      return StorageFault::io;
  }
}

std::string_view advice_for(int error_number) {
  switch (error_number) {
    case ENOSPC:
      return "; make room on this disk and run again: what was saved before is whole";
    case EDQUOT:
      return "; make room within the quota and run again: what was saved before is whole";
    case EFBIG:
      return "; raise the file size limit (ulimit -f) and run again";
    case EACCES:
    case EPERM:
      return "; check owner and permissions";
    case EROFS:
      return "; the disk is mounted read-only";
    case EEXIST:
    case ENOTDIR:
    case EISDIR:
    case ELOOP:
      return "; something else has the name of a file or folder of ours: move it away";
    default:
      return "";
  }
}

}  // namespace

std::string_view to_string(StorageFault fault) {
  switch (fault) {
    case StorageFault::disk_full:
      return "disk_full";
    case StorageFault::io:
      return "io";
    case StorageFault::unwritable:
      return "unwritable";
    case StorageFault::corrupt:
      return "corrupt";
    case StorageFault::unsupported_version:
      return "unsupported_version";
    case StorageFault::wrong_scene:
      return "wrong_scene";
    case StorageFault::invalid_content:
      return "invalid_content";
    case StorageFault::not_ours:
      return "not_ours";
    case StorageFault::already_exists:
      return "already_exists";
    case StorageFault::locked:
      return "locked";
    case StorageFault::no_usable_checkpoint:
      return "no_usable_checkpoint";
    case StorageFault::lost:
      return "lost";
  }
  return "unknown";
}

StorageError system_error(std::string_view action, const std::filesystem::path& path,
                          int error_number) {
  return {fault_of(error_number),
          fmt::format("{}: {}: {}{}", path.string(), action,
                      std::generic_category().message(error_number), advice_for(error_number))};
}

StorageError system_error(const std::filesystem::filesystem_error& error) {
  return system_error("cannot look at or change", error.path1(), error.code().value());
}

StorageError in_file(const std::filesystem::path& path, const StorageError& error) {
  const std::string prefix = path.string() + ": ";
  const std::string_view message = error.what();
  return message.starts_with(prefix)
             ? error
             : StorageError(error.fault(), fmt::format("{}{}", prefix, message));
}

std::string told_outside(const std::filesystem::path& root, std::string message) {
  constexpr std::string_view kInside = "./";
  const std::string prefix = (root / "").string();
  if (message.starts_with(prefix)) return message;
  for (std::size_t at = 0; (at = message.find(kInside, at)) != message.npos;) {
    const bool begins_a_word = at == 0 || message[at - 1] == ' ' || message[at - 1] == '(';
    if (begins_a_word) message.replace(at, kInside.size(), prefix);
    at += begins_a_word ? prefix.size() : kInside.size();
  }
  return message;
}

StorageError told_outside(const std::filesystem::path& root, const StorageError& error) {
  return {error.fault(), told_outside(root, std::string(error.what()))};
}

}  // namespace sluice

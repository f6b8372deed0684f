#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "engine/store/disk/file_system.hpp"

namespace sluice {

/// A text file that a new folder begins with.
struct FirstFile {
  std::string_view name;
  std::string_view text;
};

/// Makes a folder with these files and empty folders, whole or not at all. It is built under a
/// hidden name beside its place and moved there by one rename; whenever the process is killed or
/// the power is cut, there is no folder of that name or a complete one. On the disk, name and all,
/// when this returns. The parent must be there. Throws StorageError: already_exists, disk_full,
/// unwritable, io; nothing is left then.
void publish_folder(const std::filesystem::path& target, std::span<const FirstFile> files,
                    std::span<const std::string_view> folders,
                    FileSystem& system = FileSystem::real());

/// The same for the folder of a new job: scene.json, `more`, and an empty folder for frames.
void publish_job_folder(const std::filesystem::path& target, std::string_view scene_text,
                        const std::vector<FirstFile>& more,
                        FileSystem& system = FileSystem::real());

/// Removes what killed callers of publish_folder left in `parent`, and returns how many. Nobody
/// may be making folders in it meanwhile.
std::size_t remove_unfinished_folders(const std::filesystem::path& parent);

}  // namespace sluice

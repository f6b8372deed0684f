#pragma once

#include <filesystem>
#include <string_view>

#include "engine/store/disk/file_system.hpp"
#include "engine/store/disk/trailer.hpp"

namespace sluice {

/// What a published file must survive.
enum class Durability {
  power_cut,      ///< on the disk, name and all, when publish returns
  process_crash,  ///< handed to the system; a power cut may lose or damage it, which its trailer
                  ///< shows
};

/// Puts `image` and its trailer at `target`, whole or not at all: whatever fails, and wherever the
/// process is killed, the file that was there before stays as it was. Replaces an existing file.
/// Only the holder of a folder's lock publishes in it. Throws StorageError: disk_full, unwritable,
/// io; the temporary is gone then. When the folder cannot be synced the new file is in place, but a
/// power cut may still lose it: that throws too.
void publish(const std::filesystem::path& target, ByteSpan image, Durability durability,
             FileSystem& system = FileSystem::real());

/// The same for a text, without a trailer; always survives a power cut.
void publish_text(const std::filesystem::path& target, std::string_view text,
                  FileSystem& system = FileSystem::real());

/// Puts a text where a user's word says, which may be anything: what is no regular file, such as a
/// device, a pipe or a link, is opened and written to as a shell's > does, for a new file in its
/// place would be another thing. All else as publish_text.
void write_text(const std::filesystem::path& target, std::string_view text,
                FileSystem& system = FileSystem::real());

/// Whether there are temporaries in `folder`, of whomever.
[[nodiscard]] bool has_leftovers(const std::filesystem::path& folder);

/// Removes what killed processes left in `folder`; returns how many files. The caller holds the
/// folder's lock, so every temporary in it has lost its owner, even when a new process now has the
/// owner's number. What cannot be listed or removed now stays for the next holder.
std::size_t remove_leftovers(const std::filesystem::path& folder);

}  // namespace sluice

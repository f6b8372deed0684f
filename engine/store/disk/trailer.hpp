#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "engine/store/disk/file_system.hpp"

namespace sluice {

/// XXH3-128.
struct Hash128 {
  std::uint64_t high = 0;
  std::uint64_t low = 0;
  friend bool operator==(const Hash128&, const Hash128&) = default;
};
[[nodiscard]] Hash128 hash_bytes(ByteSpan bytes);
/// 32 hexadecimal digits, the canonical form that `xxh128sum` prints.
[[nodiscard]] std::string to_hex(const Hash128& hash);

/// The last 48 bytes of every binary file that we publish. Little endian: magic (8 bytes), version
/// (8), length of the image before it (8), XXH3-128 of the image (low 8, high 8), XXH3-64 of the 40
/// bytes so far (8). HDF5 readers ignore bytes after the image.
struct Trailer {
  static constexpr std::size_t kSize = 48;
  static constexpr std::uint64_t kVersion = 1;

  std::uint64_t version = kVersion;
  std::uint64_t length = 0;
  Hash128 hash;

  [[nodiscard]] std::array<std::byte, kSize> encode() const;
};
[[nodiscard]] Trailer make_trailer(ByteSpan image);

/// The trailer of a file, itself checked, the image not yet. Throws StorageError: corrupt when it
/// is missing, altered or does not fit the file's length; unsupported_version.
[[nodiscard]] Trailer read_trailer(const InputFile& file);

/// The image of a published file after its trailer was found right. A link is none. Throws
/// StorageError with the path: corrupt, unsupported_version, io.
[[nodiscard]] Bytes read_verified(const std::filesystem::path& path);

/// The same check without keeping the image; holds 1 MiB at a time.
void verify(const std::filesystem::path& path);

}  // namespace sluice

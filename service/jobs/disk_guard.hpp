#pragma once

#include <cstdint>
#include <filesystem>

namespace sluice {

/// Bytes that may still be written on the disk of `folder`; the largest number when the system
/// cannot tell.
[[nodiscard]] std::uint64_t free_disk(const std::filesystem::path& folder);

/// Bytes that the files in `folder` and below take on disk; what cannot be read counts nothing.
[[nodiscard]] std::uint64_t used_disk(const std::filesystem::path& folder);

}  // namespace sluice

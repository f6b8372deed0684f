#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>

namespace sluice {

/// Part of a file: `count` bytes from `first` on.
struct ByteRange {
  std::uint64_t first = 0;
  std::uint64_t count = 0;
};
struct WholeFile {};
struct NoSuchRange {};

/// Reads a Range header for a file of `size` bytes (RFC 9110, 14.2): one range of bytes. A unit
/// that is not bytes or a broken header means the whole file; several ranges are no range that we
/// have.
[[nodiscard]] std::variant<WholeFile, ByteRange, NoSuchRange> read_range(std::string_view header,
                                                                         std::uint64_t size);

}  // namespace sluice

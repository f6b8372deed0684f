#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace sluice {

/// Characters of a UTF-8 text: its bytes that do not continue a sequence. The encoding must be
/// right.
[[nodiscard]] inline std::size_t count_code_points(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

}  // namespace sluice

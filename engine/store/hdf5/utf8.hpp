#pragma once

#include <cstddef>
#include <string_view>

namespace sluice {

/// Length of the UTF-8 sequence that begins `text`, which is not empty, by RFC 3629; 0 when it is
/// none.
[[nodiscard]] std::size_t utf8_sequence(std::string_view text);

}  // namespace sluice
